// A job: every parameter once, with its meaning, unit, range and default. The parser, --set, the
// resolved job file, validation, hashes and docs/parameters.md all read the same list.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kernels/vec.h"

namespace vfplan {

struct Config {
    std::string preset = "outdoor";
    struct {
        std::string input;
        std::string layer;
        std::string kind = "outdoor";
        std::vector<double> crop_m;
        std::string doors = "open";
        std::string windows = "wall";
        std::string crs;
        double unit_m = 1;
        double snap_m = 0.001;
        double margin_m = 10;
        double clearance_m = 0;
        std::string invalid = "error";
    } site;
    struct {
        double range_min_m = 1.2;
        double range_max_m = 75;
        double max_incidence_deg = 90;
    } scanner;
    struct {
        std::string kernel = "exact";
        std::int64_t rays = 0;
    } visibility;
    struct {
        double cell_m = 0.25;
        double threshold_rad = 1;
        std::int64_t tile_cells = 1024;
    } field;
    struct {
        double partition_m = 1;
        double visible_fraction = 0.5;
    } coverage;
    struct {
        std::string ratio = "mean_len";
        double threshold = 0.3;
    } overlap;
    struct {
        std::string method = "refined";
        bool loops = true;
        double time_limit_s = 60;
        std::vector<Vec2d> required;
        std::string forbidden;
        std::vector<Vec2d> existing;
    } plan;
    struct {
        std::vector<std::string> formats = {"geojson", "gpkg", "csv", "png"};
        std::int64_t map_px = 1600;
    } output;
};

using ParameterValue =
    std::variant<std::string*, double*, std::int64_t*, bool*, std::vector<double>*,
                 std::vector<Vec2d>*, std::vector<std::string>*>;

// What a change of a parameter makes stale.
enum class Stage : std::uint8_t { tables, plan, output };

struct Parameter {
    std::string section;  // empty for the top level
    std::string name;
    std::string help;  // one line, with the unit
    Stage stage = Stage::tables;
    std::vector<std::string> choices = {};
    double least = -1e300;  // for numbers
    double most = 1e300;
    bool above_least = false;  // `least` itself is not allowed

    std::string key() const { return section.empty() ? name : section + "." + name; }
};

// All parameters in the order of the job file, bound to a configuration.
std::vector<std::pair<Parameter, ParameterValue>> parameters(Config& config);

// Reads a job file and then `--set section.key=value` overrides. Throws UsageError with file,
// line and column for a syntax error, an unknown key, a wrong type or a value out of range.
// Paths in the file are relative to it, paths in overrides to the current folder; both leave
// absolute. IoError when the file cannot be read.
Config read_config(const std::filesystem::path& file, const std::vector<std::string>& overrides);

// The same from text, `name` for messages, `folder` for relative paths.
Config parse_config(const std::string& text, const std::string& name,
                    const std::filesystem::path& folder, const std::vector<std::string>& overrides);

// The whole configuration as a job file with a comment for each key.
std::string to_toml(const Config& config);

// key = value lines of the parameters that matter up to `stage`, without paths: what two equal
// jobs share.
std::string canonical(const Config& config, Stage stage);

// docs/parameters.md.
std::string parameters_markdown();

}  // namespace vfplan
