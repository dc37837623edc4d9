// From the coverage table to a connected network of stations (docs/method.md 7). Works on
// the tables alone: no geometry.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/config/options.h"
#include "engine/plan/workspace.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"

namespace vfplan {

// What it takes that any one station may be lost, and what is lost all the same.
struct SurvivalReport {
    std::int64_t stations = 0;      // more (or fewer) than before
    std::int64_t pieces_alone = 0;  // that one candidate alone covers
    double length_alone_m = 0;
};

// What happened on the way.
struct PlanReport {
    std::int64_t greedy_stations = 0;        // Algorithm 1 alone
    std::int64_t connected = 0;              // the fewest found before loops count
    std::optional<SurvivalReport> survival;  // where it was asked for
    std::int64_t shortcuts = 0;              // stations for shorter ways
    std::int64_t off_cycle_before = 0;       // stations on no cycle in that plan,
    std::int64_t off_cycle_after = 0;        // and in the plan that is given
    std::int64_t too_near = 0;               // stations nearer to another one than min_spacing_m
};

// One network for each component of the graph that has something to add, that of the component
// which can cover most length first; stations numbered by network, then in the order of choice.
// Deterministic. Links have no ratios but that of the job yet (add_ratios). `progress`: is told of
// steps of the search.
Plan make_plan(const Threads& threads, const PlanInput& input, const PlanOptions& options,
               PlanReport& report, Progress* progress = nullptr);

}  // namespace vfplan
