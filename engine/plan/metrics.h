// How good a plan is (docs/method.md 7).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/piece_places.h"
#include "engine/plan/workspace.h"
#include "engine/runtime/parallel.h"

namespace vfplan {

// Shortest weighted paths between stations, w = 1 - O.
struct PathMeasures {
    double wapl = 0;                      // over connected ordered pairs; 0 for none
    double wapl_penalty100 = 0;           // the paper's: 100 for each pair without a path
    std::int64_t disconnected_pairs = 0;  // unordered
    std::int64_t sources = 0;             // stations that paths were measured from
    double standard_error = 0;            // of wapl; 0 when that was all of them
};

// Paths from at most `most_sources` stations, evenly spread over their numbers, to all others. With
// fewer than all, WAPL is the ratio of sums over the sample, and the error that of such a ratio.
PathMeasures measure_paths(const Threads& threads, const Graph& graph, std::int64_t most_sources);

// All pairs up to this many stations; beyond, this many sources.
inline constexpr std::int64_t wapl_of_all = 20000;
inline constexpr std::int64_t wapl_sample = 2000;

struct Metrics : PathMeasures {
    std::int64_t networks = 0;
    double bottleneck_overlap = 0;  // weakest link that the main network cannot do without
    std::int64_t bridges = 0;
    std::int64_t articulation_stations = 0;
    std::int64_t redundant_links = 0;  // m - n + c
    std::int64_t pieces_coverable = 0;
    std::int64_t pieces_covered = 0;    // by the main network
    std::int64_t pieces_unreached = 0;  // by other networks only
    double length_coverable_m = 0;
    double length_covered_m = 0;
    double length_all_m = 0;
    std::vector<std::int64_t> multiplicity;    // pieces seen by k stations, the last: or more
    std::vector<std::int64_t> range_tenths;    // station-piece pairs by tenths of range_max
    std::vector<std::int64_t> incidence_tens;  // the same by 10 degrees of incidence
    std::int64_t lower_bound = 0;              // of connected plans
};

// The share of the stations that no proof says are needed.
constexpr double gap(std::int64_t stations, std::int64_t lower_bound) {
    return stations > 0
               ? static_cast<double>(stations - lower_bound) / static_cast<double>(stations)
               : 0;
}

// Thread count changes nothing. `places` serve the histograms only.
Metrics measure(const Threads& threads, const PlanInput& input, const Plan& plan,
                const PiecePlaces& places, double range_max_m);

}  // namespace vfplan
