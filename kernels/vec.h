// Plane vectors. Metres unless a name says otherwise.
#pragma once

#include <Eigen/Core>

namespace vfplan {

using Vec2d = Eigen::Vector2d;

// z of u x v: positive when v lies counter-clockwise of u.
inline double cross(const Vec2d& u, const Vec2d& v) { return u.x() * v.y() - u.y() * v.x(); }

// Twice the signed area of abc: positive when c lies left of a -> b.
inline double orient(const Vec2d& a, const Vec2d& b, const Vec2d& c) { return cross(b - a, c - a); }

// Axis-aligned box; empty while min > max.
struct Box {
    Vec2d min{1, 1};
    Vec2d max{0, 0};

    bool empty() const { return min.x() > max.x() || min.y() > max.y(); }
    Vec2d size() const { return max - min; }
    bool contains(const Vec2d& p) const {
        return p.x() >= min.x() && p.x() <= max.x() && p.y() >= min.y() && p.y() <= max.y();
    }
    void add(const Vec2d& p) {
        if (empty()) {
            min = max = p;
        } else {
            min = min.cwiseMin(p);
            max = max.cwiseMax(p);
        }
    }
};

}  // namespace vfplan
