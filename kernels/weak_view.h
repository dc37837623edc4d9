// From where a stretch of wall may be seen at all: no cell that sees any of it is missed.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/triangulation.h"
#include "kernels/wall.h"

namespace vfplan {

// Triangular expansion from a stretch in place of a point. It remembers of the way only the
// stretch, the last edge and what both cut off of each other, so it says a little too much, never
// too little. Thread-safe.
class WeakView {
public:
    // `around`: where eyes may stand. Throws InputError as triangulate() does.
    WeakView(const std::vector<Wall>& walls, const Box& around);

    // Spaces are parts of the plane that walls enclose, numbered from 0: whatever is seen from a
    // place lies in its space. -1 for a wall that no triangle has.
    std::int32_t space(std::int32_t wall, Side side) const;
    std::int32_t spaces() const { return spaces_; }

    // Calls part() with convex polygons that together hold every point from which something
    // between s0_m and s1_m on that side of a wall can be seen, at most reach_m away. They may
    // overlap. False when there would be too many: then nothing is known.
    bool parts(std::int32_t wall, Side side, double s0_m, double s1_m, double reach_m,
               const std::function<void(std::span<const Vec2d>)>& part) const;

private:
    struct Face {
        std::int32_t triangle = -1;
        std::size_t edge = 0;
    };
    const Vec2d& corner(const Triangle& t, std::size_t i) const {
        return mesh_.vertices[static_cast<std::size_t>(t.vertex[i % 3])];
    }
    const Face& face(std::int32_t wall, Side side) const {
        return faces_[2 * static_cast<std::size_t>(wall) + side];
    }

    std::vector<Wall> walls_;
    Triangulation mesh_;
    std::vector<Face> faces_;
    std::vector<std::int32_t> space_;  // of each triangle
    std::int32_t spaces_ = 0;
};

}  // namespace vfplan
