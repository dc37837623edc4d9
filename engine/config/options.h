// What the parts of a job are told: each gets what it needs of the configuration, none the whole.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "io/site/site_options.h"
#include "kernels/candidate.h"
#include "kernels/names.h"
#include "kernels/overlap.h"
#include "kernels/scanner.h"
#include "kernels/vec.h"
#include "kernels/view_kernels.h"

namespace vfplan {

struct Config;

// The site, its grid, and where on it stations may stand.
struct GroundOptions {
    std::filesystem::path input;
    SiteOptions site;
    std::filesystem::path forbidden;  // polygons where no station may stand; may be empty
    std::vector<Vec2d> required;      // the user's points, as given
    std::vector<Vec2d> existing;
    double clearance_m = 0;
    double cell_m = 0.25;
    std::int64_t tile_cells = 1024;
    double range_max_m = 75;
    double partition_m = 1;
};
GroundOptions ground_options(const Config& config);

// What views are made with.
struct SceneOptions {
    Scanner scanner;
    KernelKind kernel = KernelKind::exact;  // of the field; other views are always exact
    int rays = 0;                           // of embree, at least
    bool more_rays = true;                  // where these would miss too much
    double visible_fraction = 0.5;
    double partition_m = 1;
};
SceneOptions scene_options(const Config& config);

// More candidates than the tables have.
struct PoolOptions {
    double tried = 14;    // points for each candidate of the tables
    double taken = 0;     // likewise, of a coarser grid
    SceneOptions scenes;  // as the tables have them
    double snap_m = 0.001;
};
// The way from a stored site to its tables.
struct TableOptions {
    SceneOptions scenes;
    std::int64_t tile_cells = 1024;
    double threshold_rad = 1;  // of the field, below which a cell carries no skeleton
    OverlapRule overlap;
    std::vector<Vec2d>
        required;  // the user's points in the site's frame; make_tables() has them from it
    std::vector<Vec2d> existing;
    std::optional<PoolOptions> pool;  // is made behind them, where the plan asks for it
};
TableOptions table_options(const Config& config);

enum class PlanMethod : std::uint8_t { greedy, refined, certified };
template <>
struct Names<PlanMethod> {
    static constexpr std::array<std::string_view, 3> all = {"greedy", "refined", "certified"};
};

struct PlanOptions {
    PlanMethod method = PlanMethod::refined;
    bool loops = true;
    OverlapRule overlap;
    std::int64_t effort = 20;          // steps of search for each station of the greedy plan
    std::int64_t proof_effort = 8000;  // as prove() has it
    CandidatePool candidates = CandidatePool::axis;
    double min_spacing_m = 0;  // stations stand farther apart where that costs little
    bool survive = false;      // the loss of any one station; loops are then asked for
    double shortcuts = 0;      // at most so many further stations, as a share of a network's
};
PlanOptions plan_options(const Config& config);

}  // namespace vfplan
