// The overlap of linked stations by every ratio.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "engine/plan/workspace.h"

namespace vfplan {

// The angles of `count` entries from `from` on, wherever they are kept. Ranges are asked for in
// ascending order, no entry twice.
using AngleSource = std::function<std::vector<float>(std::int64_t from, std::int64_t count)>;

// All ratios of the plan's links. Goes through the candidates once, in their order, and asks for
// their angles on the way: a few megabytes at a time.
void add_ratios(const PlanInput& input, const AngleSource& angles, Plan& plan);

}  // namespace vfplan
