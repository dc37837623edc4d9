#include "io/formats/json_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/formats/text.h"
#include "kernels/error.h"

namespace vfplan {

namespace {

[[noreturn]] void no_json(const std::string& text, const std::filesystem::path& file,
                          std::size_t byte) {
    throw InputError(
        fmt::format("{}:{}: {}; the file is damaged, export the site again", file.string(),
                    place_in(text, byte > 0 ? byte - 1 : 0),
                    byte >= text.size() ? "the file ends in the middle" : "this is no JSON"));
}

// Takes everything, keeps nothing but the place of the first error.
class Listener : public nlohmann::json_sax<nlohmann::json> {
public:
    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t&) override { return true; }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return true; }
    bool key(string_t&) override { return true; }
    bool end_object() override { return true; }
    bool start_array(std::size_t) override { return true; }
    bool end_array() override { return true; }
    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::json::exception&) override {
        wrong_at = position;
        return false;
    }
    std::size_t wrong_at = 0;
};

}  // namespace

nlohmann::json parse_json(const std::string& text, const std::filesystem::path& file) {
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& e) {
        no_json(text, file, e.byte);
    } catch (const nlohmann::json::exception&) {
        throw InputError(
            fmt::format("{}: a number in it is too large; export the site again", file.string()));
    }
}

void check_json(const std::string& text, const std::filesystem::path& file) {
    Listener listener;
    if (!nlohmann::json::sax_parse(text, &listener)) no_json(text, file, listener.wrong_at);
}

bool JsonAt::has(const char* key) const { return value_->is_object() && value_->contains(key); }

JsonAt JsonAt::stepped(const nlohmann::json& to, const Step& step) const {
    JsonAt out = *this;
    out.value_ = &to;
    if (depth_ < steps_.size()) out.steps_[out.depth_++] = step;
    return out;
}

JsonAt JsonAt::operator[](const char* key) const {
    if (!has(key)) fail(fmt::format("there is no \"{}\" in it", key));
    return stepped((*value_)[key], {key, 0});
}

JsonAt JsonAt::at(std::size_t index) const {
    if (index >= size()) fail(fmt::format("there is no element {} in it", index));
    return stepped((*value_)[index], {nullptr, index});
}

std::size_t JsonAt::size() const {
    if (!value_->is_array()) fail(fmt::format("a list is expected, not {}", value_->type_name()));
    return value_->size();
}

double JsonAt::number() const {
    if (!value_->is_number()) {
        fail(fmt::format("a number is expected, not {}", value_->type_name()));
    }
    return value_->get<double>();
}

std::size_t JsonAt::index(std::size_t below) const {
    if (!value_->is_number_unsigned() || value_->get<std::uint64_t>() >= below) {
        fail(fmt::format("a number from 0 to {} is expected, not {}", below - 1,
                         value_->dump(-1, ' ', true).substr(0, 40)));
    }
    return value_->get<std::size_t>();
}

std::string JsonAt::text() const {
    if (!value_->is_string()) fail(fmt::format("a text is expected, not {}", value_->type_name()));
    return value_->get<std::string>();
}

void JsonAt::fail(const std::string& problem) const {
    std::string at;
    for (std::size_t i = 0; i < depth_; ++i) {
        at += '/';
        at += steps_[i].key != nullptr ? steps_[i].key : std::to_string(steps_[i].index);
    }
    throw InputError(fmt::format("{}: at {}: {}; export the site again", file_->string(),
                                 at.empty() ? "/" : at, problem));
}

}  // namespace vfplan
