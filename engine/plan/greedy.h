// Algorithm 1 with its gaps closed (docs/method.md 7).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/workspace.h"

namespace vfplan {

// Chooses among `members` (one connected component, ascending) until every piece with wanted[piece]
// that they can cover is covered; clears `wanted` of what it covers. `forced` members are taken
// first, joined by shortest paths. Deterministic.
Chosen choose_greedily(const PlanInput& input, const std::vector<std::int32_t>& members,
                       const std::vector<std::int32_t>& forced, std::vector<std::uint8_t>& wanted,
                       Workspace& work);

}  // namespace vfplan
