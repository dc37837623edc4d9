// From greedy plans to better ones (docs/planning.md).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/config/options.h"
#include "engine/plan/workspace.h"
#include "engine/runtime/parallel.h"

namespace vfplan {

struct Network {
    std::vector<std::int32_t> members;  // a component of the graph, ascending
    Chosen chosen;
    Chosen connected;  // the best plan before loops count
};

// Makes each network better, without loops and then, where the options ask for them, with. Rows of
// network k are the pieces with owner[piece] == k; fixed[candidate] stays. The number of threads
// changes nothing.
void refine(const Threads& threads, const PlanInput& input, const PlanOptions& options,
            const std::vector<std::int32_t>& owner, const std::vector<std::uint8_t>& fixed,
            std::vector<Network>& networks);

}  // namespace vfplan
