// Taking out what a network does not need.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/workspace.h"

namespace vfplan {

// Takes out, last chosen first, what neither coverage nor connection needs. `kept` (by candidate)
// must stay; `count` holds how many stations of this network and those before it cover each
// piece, and is kept up to date.
Chosen prune(const PlanInput& input, const Chosen& chosen, const std::vector<std::uint8_t>& kept,
             std::vector<std::int32_t>& count, Workspace& work);

}  // namespace vfplan
