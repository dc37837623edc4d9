// Putting every station on a cycle of links.
#pragma once

#include "engine/plan/workspace.h"

namespace vfplan {

// Adds, for each station on no cycle, the fewest candidates that put it on one through another
// station, where there are any. Once for each network of a work space.
Chosen close_loops(const PlanInput& input, const Chosen& chosen, Workspace& work);

}  // namespace vfplan
