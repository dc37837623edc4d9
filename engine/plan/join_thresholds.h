// Why networks stay apart: at which overlap they would join, if at any.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/plan.h"
#include "engine/runtime/parallel.h"

namespace vfplan {

struct JoinThresholds {
    // For each network: the largest threshold at which a chain of candidates joins it to the main
    // one; 1 for the main one itself, 0 when nothing that it sees is seen from there, however
    // little (an enclosed courtyard, say).
    std::vector<double> joins_at;
    // How many networks there would be with min_len at the same threshold.
    std::int64_t networks_by_min_len = 0;
};

// Over all candidates, by the job's ratio. Nothing is computed for a single network. Looks at pairs
// of candidates in different components of the graph only, which are few; where the ratio is one by
// angle, `networks_by_min_len` needs all pairs and an index of all rows.
JoinThresholds find_join_thresholds(const Threads& threads, const PlanInput& input,
                                    const OverlapRule& rule, const Plan& plan);

}  // namespace vfplan
