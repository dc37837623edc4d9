// Where a direction meets a wall's line.
#pragma once

#include <algorithm>

#include "kernels/wall.h"

namespace vfplan {

// Metres from wall.a to where the ray from `eye` along `direction` meets the wall's line, kept on
// the wall. A direction to one of the wall's own ends gives exactly 0 or `length_m`.
inline double shadow_m(const Wall& wall, double length_m, const Vec2d& eye,
                       const Vec2d& direction) {
    if (direction == wall.a - eye) return 0;
    if (direction == wall.b - eye) return length_m;
    const double u = cross(wall.a - eye, direction) / cross(direction, wall.b - wall.a);
    return length_m * std::clamp(u, 0.0, 1.0);
}

}  // namespace vfplan
