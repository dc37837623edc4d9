// The one door to CGAL: a constrained Delaunay triangulation of the walls as flat arrays.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernels/wall.h"

namespace vfplan {

// Counter-clockwise triangles. Edge i lies opposite vertex i.
struct Triangle {
    std::array<std::int32_t, 3> vertex;
    std::array<std::int32_t, 3> neighbour;  // -1 beyond the hull
    std::array<std::int32_t, 3> wall;       // -1 where the edge is no wall
};

struct Triangulation {
    std::vector<Vec2d> vertices;
    std::vector<Triangle> triangles;
};

// Triangulates the walls inside a square that reaches `margin_m` beyond them and `around`, so
// that every eye inside the square stands in a triangle (an eye outside the hull sees nothing).
// Throws InputError when walls cross or overlap: cleaning must come first.
// Thread-safe. Time O(n log n).
Triangulation triangulate(const std::vector<Wall>& walls, const Box& around, double margin_m);

}  // namespace vfplan
