// Why networks stay apart: at which overlap they would join, if at any.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/plan.h"
#include "engine/runtime/parallel.h"
#include "io/tables/join_shards.h"

namespace vfplan {

struct JoinThresholds {
    // For each network: the largest threshold at which a chain of candidates joins it to the main
    // one; 1 for the main one itself, 0 when nothing that it sees is seen from there, however
    // little (an enclosed courtyard, say).
    std::vector<double> joins_at;
    // Free cells that the chains may lead over; 0: over candidates only.
    std::int64_t free_cells = 0;
    // How many networks there would be with min_len at the same threshold, over candidates.
    std::int64_t networks_by_min_len = 0;
};

// By the job's ratio over all candidates, and over all free cells where the tables know how far
// apart they are: made by the same ratio and for no lower a threshold. Nothing is computed for a
// single network. Looks at pairs of candidates in different components of the graph only, which are
// few; where the ratio is one by angle, `networks_by_min_len` needs all pairs and an index of all
// rows.
JoinThresholds find_join_thresholds(const Threads& threads, const PlanInput& input,
                                    const OverlapRule& rule, const Apart& apart, const Plan& plan);

}  // namespace vfplan
