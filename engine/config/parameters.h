// The list of parameters, bound to the values of a configuration.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "engine/config/config.h"

namespace vfplan {

// What a change of a parameter makes stale, and all behind it.
enum class Stale : std::uint8_t { tables, plan, output };

// A value of an enumeration and the names of all its values.
struct Choice {
    std::uint8_t* value;
    std::span<const std::string_view> names;
};

using ParameterValue = std::variant<std::string*, std::filesystem::path*, double*, std::int64_t*,
                                    bool*, Choice, std::vector<double>*, std::vector<Vec2d>*,
                                    std::vector<std::string>*, std::vector<RoleRule>*>;

// Of a number.
struct Limits {
    double least = -1e300;
    double most = 1e300;
    bool above_least = false;  // `least` itself is not allowed
};

struct Parameter {
    std::string section;  // empty for the top level
    std::string name;
    ParameterValue value;
    Stale stale = Stale::tables;
    std::string help;  // one line, with the unit
    Limits limits = {};

    std::string key() const { return section.empty() ? name : section + "." + name; }
    // What a choice, or an element of a list, may be; empty for other kinds.
    std::vector<std::string> choices() const;
};

// In the order of the job file.
std::vector<Parameter> parameters(Config& config);

// The value as TOML.
std::string text_of(const ParameterValue& value);

// key = value lines of the parameters that matter up to a stage, without paths: what two equal
// jobs share.
std::string canonical(const Config& config, Stale stage);

// The paths of a configuration that are set, in the order of parameters. Throws IoError, naming the
// parameter, when one leads nowhere.
std::vector<std::filesystem::path> existing_paths(const Config& config);

// docs/parameters.md.
std::string parameters_markdown();

}  // namespace vfplan
