// In which order the stations of a network are numbered.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/workspace.h"

namespace vfplan {

// As Algorithm 1 would choose among them: first the one that covers most length, then always one
// that is linked to those before it and adds most length to what is `covered` (by piece, 1), among
// equals the one with the highest overlap, then the lowest candidate. `covered` is left as it was.
// REQUIRES: `network` hangs together.
Chosen in_order(const PlanInput& input, const Chosen& network,
                const std::vector<std::uint8_t>& covered, Workspace& work);

}  // namespace vfplan
