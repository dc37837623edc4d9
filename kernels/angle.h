// Angles without the C library: glibc picks its atan2 by processor, and the last bit with it.
// Only + - * / and sqrt, which IEEE 754 fixes, so the bits are the same everywhere.
#pragma once

#include <cmath>
#include <vector>

#include "kernels/vec.h"

namespace vfplan {

inline constexpr double pi = 3.14159265358979323846;

// Arc tangent, absolute error below 3e-16.
double atan_exact_bits(double x);

// Angle from u to v, counter-clockwise, in [0, 2 pi). REQUIRES: u, v not zero.
double angle_between_rad(const Vec2d& u, const Vec2d& v);

// The angle whose tangent is y / x for y >= 0: in [0, pi]. (0, 0) gives 0.
double angle_upper_rad(double y, double x);

// A number in [0, 4) that grows with the direction of d counter-clockwise from +x.
inline double pseudo_angle(const Vec2d& d) {
    const double sum = std::abs(d.x()) + std::abs(d.y());
    const double p = d.y() / sum;
    if (d.x() < 0) return 2 - p;
    return d.y() < 0 ? 4 + p : p;
}

// `count` unit vectors evenly round the circle from +x, counter-clockwise, by halving angles.
// REQUIRES: count is a power of two, at least 4.
std::vector<Vec2d> circle_directions(int count);

}  // namespace vfplan
