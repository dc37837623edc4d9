// What each station is to its plan.
#pragma once

#include "engine/plan/workspace.h"

namespace vfplan {

// For each station of a plan with links: the length that only it covers of all stations
// (only_length_m), whether its network falls apart without it (articulation), whether a link of it
// is the only way between its two sides (bridge_end), and the weakest link at it that its network's
// strongest tree of links runs along (needed_overlap; 0 for a station without links).
void add_roles(const PlanInput& input, Plan& plan);

}  // namespace vfplan
