#include "engine/config/parameters.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "engine/config/toml_values.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

Limits from(double least, double most) { return {least, most, false}; }
Limits above(double least, double most) { return {least, most, true}; }

template <class E>
Choice choice(E& value) {
    static_assert(sizeof(E) == 1);
    return {reinterpret_cast<std::uint8_t*>(&value), names_of<E>()};
}

}  // namespace

std::vector<Parameter> parameters(Config& config) {
    using enum Stale;
    std::vector<Parameter> out;
    out.push_back({"", "preset", choice(config.preset), tables,
                   "the paper's defaults for all below: outdoor or indoor"});
    const auto add = [&](const char* section, const char* name, ParameterValue value, Stale stale,
                         const std::string& help, const Limits& limits = {}) {
        out.push_back({section, name, value, stale, help, limits});
    };
#define SECTION(section)
#define END(section)
#define TEXT(section, name, outdoors, indoors, stale, help) \
    add(#section, #name, &config.section.name, stale, help);
#define PATH(section, name, stale, help) add(#section, #name, &config.section.name, stale, help);
#define NUMBER(section, name, outdoors, indoors, stale, help, limits) \
    add(#section, #name, &config.section.name, stale, help, limits);
#define WHOLE(section, name, outdoors, indoors, stale, help, limits) \
    add(#section, #name, &config.section.name, stale, help, limits);
#define FLAG(section, name, outdoors, indoors, stale, help) \
    add(#section, #name, &config.section.name, stale, help);
#define CHOICE(type, section, name, outdoors, indoors, stale, help) \
    add(#section, #name, choice(config.section.name), stale, help);
#define NUMBERS(section, name, stale, help) add(#section, #name, &config.section.name, stale, help);
#define POINTS(section, name, stale, help) add(#section, #name, &config.section.name, stale, help);
#define ROLES(section, name, stale, help) add(#section, #name, &config.section.name, stale, help);
#define FORMATS(section, name, stale, help)           \
    add(#section, #name, &config.section.name, stale, \
        fmt::format("{}{}", help, fmt::join(output_formats(), ", ")));
#include "engine/config/parameters.def"
#include "engine/config/undefine.def"
    return out;
}

std::vector<std::string> Parameter::choices() const {
    if (const auto* of = std::get_if<Choice>(&value)) return {of->names.begin(), of->names.end()};
    if (std::holds_alternative<std::vector<std::string>*>(value)) return output_formats();
    if (std::holds_alternative<std::vector<RoleRule>*>(value)) {
        const auto roles = names_of<Role>();
        return {roles.begin(), roles.end()};
    }
    return {};
}

std::string canonical(const Config& config, Stale stage) {
    Config copy = config;
    std::string out;
    for (const Parameter& p : parameters(copy)) {
        const bool path = std::holds_alternative<std::filesystem::path*>(p.value);
        if (p.stale > stage || path || p.section.empty()) continue;
        out += fmt::format("{} = {}\n", p.key(), text_of(p.value));
    }
    return out;
}

std::vector<std::filesystem::path> existing_paths(const Config& config) {
    Config copy = config;
    std::vector<std::filesystem::path> out;
    for (const Parameter& p : parameters(copy)) {
        const auto* path = std::get_if<std::filesystem::path*>(&p.value);
        if (path == nullptr || (*path)->empty()) continue;
        std::error_code error;
        if (!std::filesystem::exists(**path, error)) {
            throw IoError(
                fmt::format("{}: no such file; check {} (in a job file it is relative to that "
                            "file, in --set to the current folder)",
                            (*path)->string(), p.key()));
        }
        out.push_back(**path);
    }
    return out;
}

std::string parameters_markdown() {
    Config outdoor = config_of(Preset::outdoor);
    Config indoor = config_of(Preset::indoor);
    indoor.preset = Preset::indoor;
    const auto a = parameters(outdoor);
    const auto b = parameters(indoor);
    std::string out =
        "# Parameters of a job\n\nMade by `vfplan parameters`; the program and this page share one "
        "list.\n\n| key | outdoor | indoor | meaning | values |\n|---|---|---|---|---|\n";
    for (std::size_t i = 0; i < a.size(); ++i) {
        const Parameter& p = a[i];
        std::string values = fmt::format("{}", fmt::join(p.choices(), ", "));
        if (values.empty() && p.limits.least > -1e300) {
            values = fmt::format("{} {} to {}", p.limits.above_least ? "above" : "from",
                                 p.limits.least, p.limits.most);
        }
        out += fmt::format("| `{}` | {} | {} | {} | {} |\n", p.key(), text_of(p.value),
                           text_of(b[i].value), p.help, values);
    }
    return out;
}

}  // namespace vfplan
