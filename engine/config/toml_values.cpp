#include "engine/config/toml_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "kernels/error.h"

namespace vfplan {
namespace {

std::string shown(const toml::node& node) {
    std::ostringstream out;
    node.visit([&](const auto& n) { out << n; });
    return out.str();
}

[[noreturn]] void bad_value(const Parameter& p, const toml::node& value, const Place& place,
                            const std::string& why) {
    throw UsageError(fmt::format("{} = {} ({}): {}", p.key(), shown(value), place.text(), why));
}

void check_number(const Parameter& p, double v, const toml::node& value, const Place& place) {
    const auto& [least, most, above_least] = p.limits;
    if (std::isfinite(v) && v <= most && (above_least ? v > least : v >= least)) return;
    bad_value(p, value, place,
              fmt::format("must be {} {} and at most {}; it is: {}",
                          above_least ? "greater than" : "at least", least, most, p.help));
}

double number_in(const Parameter& p, const toml::node& node, const Place& place) {
    if (!node.is_number()) bad_value(p, node, place, "must be a number; it is: " + p.help);
    const double v = *node.value<double>();
    if (!std::isfinite(v)) bad_value(p, node, place, "must be a finite number");
    return v;
}

// The number of a choice.
std::size_t choice_in(const Parameter& p, const std::string& v, const toml::node& value,
                      const Place& place) {
    const std::vector<std::string> choices = p.choices();
    const auto found = std::find(choices.begin(), choices.end(), v);
    if (found == choices.end()) {
        bad_value(p, value, place, fmt::format("must be one of: {}", fmt::join(choices, ", ")));
    }
    return static_cast<std::size_t>(found - choices.begin());
}

std::string text_in(const Parameter& p, const toml::node& value, const Place& place) {
    const auto v = value.value<std::string>();
    if (!value.is_string() || !v) {
        bad_value(p, value, place, "must be text in quotes; it is: " + p.help);
    }
    return *v;
}

const toml::array& array_in(const Parameter& p, const toml::node& value, const Place& place) {
    if (const toml::array* a = value.as_array()) return *a;
    bad_value(p, value, place, "must be a list in [ ]; it is: " + p.help);
}

// One overload per kind of parameter.
struct Setter {
    const Parameter& p;
    const toml::node& value;
    const Place& place;

    void operator()(std::string* to) const { *to = text_in(p, value, place); }
    void operator()(std::filesystem::path* to) const { *to = text_in(p, value, place); }
    void operator()(const Choice& to) const {
        *to.value = static_cast<std::uint8_t>(choice_in(p, text_in(p, value, place), value, place));
    }
    void operator()(double* to) const {
        const double v = number_in(p, value, place);
        check_number(p, v, value, place);
        *to = v;
    }
    void operator()(std::int64_t* to) const {
        const auto* v = value.as_integer();
        if (v == nullptr) bad_value(p, value, place, "must be a whole number; it is: " + p.help);
        check_number(p, static_cast<double>(v->get()), value, place);
        *to = v->get();
    }
    void operator()(bool* to) const {
        const auto* v = value.as_boolean();
        if (v == nullptr) bad_value(p, value, place, "must be true or false; it is: " + p.help);
        *to = v->get();
    }
    void operator()(std::vector<double>* to) const {
        to->clear();
        for (const toml::node& n : array_in(p, value, place)) to->push_back(number_in(p, n, place));
    }
    void operator()(std::vector<Vec2d>* to) const {
        to->clear();
        for (const toml::node& n : array_in(p, value, place)) {
            const toml::array* pair = n.as_array();
            if (pair == nullptr || pair->size() != 2) {
                bad_value(p, value, place, "must be a list of [x, y] pairs");
            }
            to->emplace_back(number_in(p, *pair->get(0), place),
                             number_in(p, *pair->get(1), place));
        }
    }
    void operator()(std::vector<RoleRule>* to) const {
        const toml::table* rules = value.as_table();
        if (rules == nullptr) {
            bad_value(p, value, place, R"(must be a table in { }, such as { "A-WALL*" = "wall" })");
        }
        to->clear();
        for (const auto& [pattern, role] : *rules) {
            const std::size_t number = choice_in(p, text_in(p, role, place), value, place);
            to->push_back({std::string(pattern.str()), static_cast<Role>(number)});
        }
    }
    void operator()(std::vector<std::string>* to) const {
        to->clear();
        for (const toml::node& n : array_in(p, value, place)) {
            const auto v = n.value<std::string>();
            if (!n.is_string() || !v) bad_value(p, value, place, "must be a list of texts");
            choice_in(p, *v, value, place);
            to->push_back(*v);
        }
    }
};

// Between double quotes. The library's own writer takes three single ones for a text of several
// lines, and does not look whether they stand in it.
std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (code < 0x20 || code == 0x7f) {
            out += fmt::format("\\u{:04x}", code);
        } else {
            out += c;
        }
    }
    return out + "\"";
}

struct Writer {
    std::string operator()(const std::string* v) const {
        const bool plain = std::none_of(v->begin(), v->end(), [](unsigned char c) {
            return c < 0x20 || c == 0x7f || c == '\'';
        });
        if (!plain) return quoted(*v);
        std::ostringstream out;
        out << toml::value<std::string>(*v);
        return out.str();
    }
    std::string operator()(const std::filesystem::path* v) const {
        const std::string text = v->string();
        return (*this)(&text);
    }
    std::string operator()(const Choice& v) const {
        const std::string text(v.names[*v.value]);
        return (*this)(&text);
    }
    std::string operator()(const double* v) const { return fmt::format("{}", *v); }
    std::string operator()(const std::int64_t* v) const { return fmt::format("{}", *v); }
    std::string operator()(const bool* v) const { return *v ? "true" : "false"; }
    std::string operator()(const std::vector<double>* v) const {
        return fmt::format("[{}]", fmt::join(*v, ", "));
    }
    std::string operator()(const std::vector<Vec2d>* v) const {
        std::vector<std::string> pairs;
        for (const Vec2d& p : *v) pairs.push_back(fmt::format("[{}, {}]", p.x(), p.y()));
        return fmt::format("[{}]", fmt::join(pairs, ", "));
    }
    std::string operator()(const std::vector<RoleRule>* v) const {
        std::vector<std::string> rules;
        for (const RoleRule& r : *v) {
            const std::string role(name_of(r.role));
            rules.push_back(fmt::format("{} = {}", (*this)(&r.pattern), (*this)(&role)));
        }
        return rules.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(rules, ", "));
    }
    std::string operator()(const std::vector<std::string>* v) const {
        std::vector<std::string> texts;
        for (const std::string& s : *v) texts.push_back((*this)(&s));
        return fmt::format("[{}]", fmt::join(texts, ", "));
    }
};

}  // namespace

std::string Place::text() const {
    return line == 0 ? name : fmt::format("{}:{}:{}", name, line, column);
}

Place place_of(const toml::source_region& s, const std::string& name) {
    return {name, static_cast<std::uint32_t>(s.begin.line),
            static_cast<std::uint32_t>(s.begin.column)};
}

void set_value(const Parameter& p, const toml::node& value, const Place& place) {
    std::visit(Setter{p, value, place}, p.value);
}

std::string text_of(const ParameterValue& value) {
    return std::visit([](const auto& v) { return Writer()(v); }, value);
}

}  // namespace vfplan
