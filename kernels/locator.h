// Which triangle an eye stands in.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/triangulation.h"

namespace vfplan {

// Walks across a triangulation, from the triangle of the last eye or from a coarse grid's seed.
//  (1) the answer depends on the eye only, not on where the walk began: an eye on an edge belongs
//      to the triangle with the lower number
// Refers to the triangulation. Thread-safe.
class TriangleLocator {
public:
    TriangleLocator(const Triangulation& mesh, const Box& around);

    // `near`: the triangle of an eye close by, -1 for none. -1 when no triangle contains the eye.
    std::int32_t locate(const Vec2d& eye, std::int32_t near = -1) const;

private:
    // orient() of the edge's ends and the eye, the same number seen from both triangles.
    double side_of(const Triangle& t, std::size_t edge, const Vec2d& eye) const;
    bool walk(std::int32_t from, const Vec2d& eye, std::int32_t& found) const;
    bool contains(std::int32_t triangle, const Vec2d& eye) const;
    std::int32_t lowest_of(std::int32_t triangle, const Vec2d& eye) const;

    const Triangulation& mesh_;
    Vec2d seeds_origin_{0, 0};
    double seeds_cell_m_ = 1;
    std::int32_t seeds_nx_ = 0;
    std::vector<std::int32_t> seeds_;  // a triangle for each square of the coarse grid
};

}  // namespace vfplan
