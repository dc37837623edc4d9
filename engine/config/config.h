// A job: the values of all parameters (engine/config/parameters.def declares them).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/options.h"
#include "io/exports/outputs.h"
#include "kernels/names.h"

namespace vfplan {

enum class Preset : std::uint8_t { outdoor, indoor };
template <>
struct Names<Preset> {
    static constexpr std::array<std::string_view, 2> all = {"outdoor", "indoor"};
};

// One struct a section, one member a parameter, with the defaults of the outdoor preset:
// config.scanner.range_max_m.
struct Config {
    Preset preset = Preset::outdoor;
#define SECTION(section) struct {
#define END(section) \
    }                \
    section;
#define TEXT(section, name, outdoors, indoors, stale, help) std::string name = outdoors;
#define PATH(section, name, stale, help) std::filesystem::path name;
#define NUMBER(section, name, outdoors, indoors, stale, help, limits) double name = outdoors;
#define WHOLE(section, name, outdoors, indoors, stale, help, limits) std::int64_t name = outdoors;
#define FLAG(section, name, outdoors, indoors, stale, help) bool name = outdoors;
#define CHOICE(type, section, name, outdoors, indoors, stale, help) type name = type::outdoors;
#define NUMBERS(section, name, stale, help) std::vector<double> name;
#define POINTS(section, name, stale, help) std::vector<Vec2d> name;
#define ROLES(section, name, stale, help) std::vector<RoleRule> name;
#define FORMATS(section, name, stale, help) std::vector<std::string> name = output_formats();
#include "engine/config/parameters.def"
#include "engine/config/undefine.def"
};

// The defaults of a preset.
Config config_of(Preset preset);

// Reads a job file and then `--set section.key=value` overrides. Throws UsageError with file,
// line and column for a syntax error, an unknown key, a wrong type or a value out of range; for a
// file of more than 16 MB and values that nest without an end.
// Paths in the file are relative to it, paths in overrides to the current folder; both leave
// absolute. IoError when the file cannot be read.
Config read_config(const std::filesystem::path& file, const std::vector<std::string>& overrides);

// The same from text, `name` for messages, `folder` for relative paths.
Config parse_config(const std::string& text, const std::string& name,
                    const std::filesystem::path& folder, const std::vector<std::string>& overrides);

// The whole configuration as a job file with a comment for each key.
std::string to_toml(const Config& config);

}  // namespace vfplan
