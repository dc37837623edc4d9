#include "engine/config.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "io/files.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using Entry = std::pair<Parameter, ParameterValue>;

// Where a value stands, for messages.
struct Place {
    std::string name;  // file, or "--set"
    std::uint32_t line = 0;
    std::uint32_t column = 0;

    std::string text() const {
        return line == 0 ? name : fmt::format("{}:{}:{}", name, line, column);
    }
};

Place place_of(const toml::source_region& s, const std::string& name) {
    return {name, static_cast<std::uint32_t>(s.begin.line),
            static_cast<std::uint32_t>(s.begin.column)};
}

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
    if (std::isfinite(v) && v <= p.most && (p.above_least ? v > p.least : v >= p.least)) return;
    std::string range;
    if (p.most >= 1e300) {
        range = fmt::format("must be {} {}", p.above_least ? "greater than" : "at least", p.least);
    } else {
        range = fmt::format("must be {} {} and at most {}",
                            p.above_least ? "greater than" : "at least", p.least, p.most);
    }
    bad_value(p, value, place, fmt::format("{}; it is: {}", range, p.help));
}

double number_in(const Parameter& p, const toml::node& node, const Place& place) {
    if (!node.is_number()) bad_value(p, node, place, "must be a number; it is: " + p.help);
    const double v = *node.value<double>();
    if (!std::isfinite(v)) bad_value(p, node, place, "must be a finite number");
    return v;
}

void check_choice(const Parameter& p, const std::string& v, const toml::node& value,
                  const Place& place) {
    if (p.choices.empty() || std::find(p.choices.begin(), p.choices.end(), v) != p.choices.end()) {
        return;
    }
    bad_value(p, value, place, fmt::format("must be one of: {}", fmt::join(p.choices, ", ")));
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

    void operator()(std::string* to) const {
        const auto v = value.value<std::string>();
        if (!value.is_string() || !v) {
            bad_value(p, value, place, "must be text in quotes; it is: " + p.help);
        }
        check_choice(p, *v, value, place);
        *to = *v;
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
    void operator()(std::vector<std::string>* to) const {
        to->clear();
        for (const toml::node& n : array_in(p, value, place)) {
            const auto v = n.value<std::string>();
            if (!n.is_string() || !v) bad_value(p, value, place, "must be a list of texts");
            check_choice(p, *v, value, place);
            to->push_back(*v);
        }
    }
};

std::size_t edit_distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t k = 0; k <= b.size(); ++k) row[k] = k;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t k = 1; k <= b.size(); ++k) {
            const std::size_t up = row[k];
            row[k] =
                std::min({row[k] + 1, row[k - 1] + 1, diagonal + (a[i - 1] == b[k - 1] ? 0U : 1U)});
            diagonal = up;
        }
    }
    return row.back();
}

// `known`: what could have been meant.
[[noreturn]] void unknown_key(const std::set<std::string>& known, const std::string& key,
                              const Place& place) {
    const auto nearest = std::min_element(known.begin(), known.end(),
                                          [&](const std::string& a, const std::string& b) {
                                              return edit_distance(key, a) < edit_distance(key, b);
                                          });
    const bool near = edit_distance(key, *nearest) <= 1 + key.size() / 3;
    throw UsageError(fmt::format(
        "{} ({}): no such parameter; {}", key, place.text(),
        near ? fmt::format("did you mean {}?", *nearest) : "docs/parameters.md lists all"));
}

void apply(const std::vector<Entry>& all, const std::string& key, const toml::node& value,
           const Place& place) {
    for (const Entry& e : all) {
        if (e.first.key() != key) continue;
        std::visit(Setter{e.first, value, place}, e.second);
        return;
    }
    std::set<std::string> known;
    for (const Entry& e : all) {
        known.insert(value.is_table() && !e.first.section.empty() ? e.first.section
                                                                  : e.first.key());
    }
    unknown_key(known, key, place);
}

void apply_table(const std::vector<Entry>& all, const toml::table& table, const std::string& prefix,
                 const std::string& name) {
    for (const auto& [key, node] : table) {
        const std::string full =
            prefix.empty() ? std::string(key.str()) : prefix + "." + std::string(key.str());
        const Place place = place_of(key.source(), name);
        const bool section = std::any_of(all.begin(), all.end(),
                                         [&](const Entry& e) { return e.first.section == full; });
        if (prefix.empty() && section) {
            if (!node.is_table()) {
                throw UsageError(
                    fmt::format("{} ({}): this is a section; write [{}] on a line of "
                                "its own and its keys below",
                                full, place.text(), full));
            }
            apply_table(all, *node.as_table(), full, name);
        } else {
            apply(all, full, node, place);
        }
    }
}

void apply_preset(Config& c) {
    if (c.preset != "indoor") return;
    c.site.kind = "indoor";
    c.site.margin_m = 0;
    c.scanner.range_min_m = 0.6;
    c.scanner.range_max_m = 30;
    c.field.cell_m = 0.02;
    c.coverage.partition_m = 0.1;
    c.overlap.threshold = 0.4;
}

// "section.key=value", the value as TOML, or as plain text where that is no TOML.
struct Override {
    std::string key;
    toml::table holder;  // keeps the value alive under "v"
};

Override parse_override(const std::string& text) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
        throw UsageError(
            fmt::format("--set {}: must be section.key=value, for example --set "
                        "field.cell_m=2",
                        text));
    }
    Override out;
    out.key = text.substr(0, equals);
    const std::string value = text.substr(equals + 1);
    try {
        out.holder = toml::parse("v = " + value);
    } catch (const toml::parse_error&) {
        out.holder = toml::table{{"v", value}};
    }
    return out;
}

toml::table parse_toml(const std::string& text, const std::string& name) {
    try {
        return toml::parse(text, name);
    } catch (const toml::parse_error& e) {
        throw UsageError(fmt::format("{}: {}; correct the TOML there",
                                     place_of(e.source(), name).text(), e.description()));
    }
}

void make_absolute(std::string& path, const std::filesystem::path& folder) {
    if (path.empty()) return;
    path = std::filesystem::absolute(folder / path).lexically_normal().string();
}

void check_together(const Config& c, const std::string& name) {
    const auto fail = [&](const std::string& what) {
        throw UsageError(fmt::format("{}: {}", name, what));
    };
    if (c.site.input.empty()) {
        fail("site.input is missing; name the site's file under [site], input = \"town.geojson\"");
    }
    if (c.scanner.range_min_m >= c.scanner.range_max_m) {
        fail(
            fmt::format("scanner.range_min_m = {} is not below range_max_m = {}; nothing could "
                        "be observed",
                        c.scanner.range_min_m, c.scanner.range_max_m));
    }
    if (!c.site.crop_m.empty() &&
        (c.site.crop_m.size() != 4 || c.site.crop_m[0] >= c.site.crop_m[2] ||
         c.site.crop_m[1] >= c.site.crop_m[3])) {
        fail("site.crop_m must be x0, y0, x1, y1 with x0 < x1 and y0 < y1");
    }
    const std::int64_t rays = c.visibility.rays;
    if (rays != 0 && (rays < 16 || (rays & (rays - 1)) != 0)) {
        fail(fmt::format("visibility.rays = {} must be 0 or a power of two from 16 on", rays));
    }
    if (c.field.tile_cells % 4 != 0) {
        fail(
            fmt::format("field.tile_cells = {} must be a multiple of 4, as cells are looked at in "
                        "blocks of 4 x 4; {} is one",
                        c.field.tile_cells, c.field.tile_cells / 4 * 4));
    }
}

struct Writer {
    std::string operator()(const std::string* v) const {
        std::ostringstream out;
        out << toml::value<std::string>(*v);
        return out.str();
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
    std::string operator()(const std::vector<std::string>* v) const {
        std::vector<std::string> quoted;
        for (const std::string& s : *v) quoted.push_back((*this)(&s));
        return fmt::format("[{}]", fmt::join(quoted, ", "));
    }
};

}  // namespace

Config parse_config(const std::string& text, const std::string& name,
                    const std::filesystem::path& folder,
                    const std::vector<std::string>& overrides) {
    const toml::table file = parse_toml(text, name);
    std::vector<Override> sets;
    for (const std::string& s : overrides) sets.push_back(parse_override(s));
    Config config;
    const auto all = parameters(config);
    // The preset first: it sets the defaults that the other keys replace.
    if (const toml::node* preset = file.get("preset")) {
        apply(all, "preset", *preset, place_of(preset->source(), name));
    }
    for (const Override& o : sets) {
        if (o.key == "preset") apply(all, o.key, *o.holder.get("v"), {"--set"});
    }
    apply_preset(config);
    const std::string chosen_preset = config.preset;
    apply_table(all, file, "", name);
    config.preset = chosen_preset;
    make_absolute(config.site.input, folder);
    make_absolute(config.plan.forbidden, folder);
    for (const Override& o : sets) {
        apply(all, o.key, *o.holder.get("v"), {"--set"});
        if (o.key == "site.input") make_absolute(config.site.input, ".");
        if (o.key == "plan.forbidden") make_absolute(config.plan.forbidden, ".");
    }
    check_together(config, name);
    return config;
}

Config read_config(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        throw UsageError(
            fmt::format("{}: no such job file; configs/ has some to copy", file.string()));
    }
    if (std::filesystem::is_directory(file, ignored)) {
        throw UsageError(fmt::format("{}: is a folder, not a job file", file.string()));
    }
    return parse_config(read_text(file), file.string(), file.parent_path(), overrides);
}

std::string to_toml(const Config& config) {
    Config copy = config;
    std::string out;
    std::string section;
    for (const auto& [p, value] : parameters(copy)) {
        if (p.section != section) {
            section = p.section;
            out += fmt::format("\n[{}]\n", section);
        }
        const std::string line = fmt::format(
            "{} = {}", p.name, std::visit([](const auto* v) { return Writer()(v); }, value));
        out += fmt::format("{:<32}  # {}\n", line, p.help);
    }
    return out;
}

std::string canonical(const Config& config, Stage stage) {
    Config copy = config;
    std::string out;
    for (const auto& [p, value] : parameters(copy)) {
        if (p.stage > stage || p.key() == "site.input" || p.key() == "plan.forbidden" ||
            p.key() == "preset") {
            continue;
        }
        out += fmt::format("{} = {}\n", p.key(),
                           std::visit([](const auto* v) { return Writer()(v); }, value));
    }
    return out;
}

std::string parameters_markdown() {
    Config outdoor;
    Config indoor;
    indoor.preset = "indoor";
    apply_preset(indoor);
    const auto a = parameters(outdoor);
    const auto b = parameters(indoor);
    std::string out =
        "# Parameters of a job\n\nMade by `vfplan parameters`; the program and this page share one "
        "list.\n\n| key | outdoor | indoor | meaning | values |\n|---|---|---|---|---|\n";
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Parameter& p = a[i].first;
        const auto text = [](const ParameterValue& v) {
            return std::visit([](const auto* x) { return Writer()(x); }, v);
        };
        std::string values = fmt::format("{}", fmt::join(p.choices, ", "));
        if (values.empty() && p.least > -1e300) {
            values = fmt::format("{} {} to {}", p.above_least ? "above" : "from", p.least, p.most);
        }
        out += fmt::format("| `{}` | {} | {} | {} | {} |\n", p.key(), text(a[i].second),
                           text(b[i].second), p.help, values);
    }
    return out;
}

}  // namespace vfplan
