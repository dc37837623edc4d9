// From first walls along directions to exact spans: where two neighbouring rays meet different
// walls, the change must lie at a wall's end. Rays are added only where the two walls at hand do
// not explain it.
#pragma once

#include <functional>
#include <vector>

#include "kernels/view.h"

namespace vfplan {

// Fills wall[i] with the first wall along unit vector direction[i], -1 for none.
using TraceRays =
    std::function<void(const std::vector<Vec2d>& direction, std::vector<std::int32_t>& wall)>;

// `directions`: unit vectors counter-clockwise once round, at least 8, evenly spread.
//  (1) each change of wall lies at the end of one of the two, seen past by a ray, or between two
//      rays less than 1e-9 rad apart
//  (2) the result depends on the walls that `trace` names only, not on its distances
void follow_transitions(const std::vector<Wall>& walls, const Vec2d& eye,
                        const std::vector<Vec2d>& directions, const TraceRays& trace, View& out);

}  // namespace vfplan
