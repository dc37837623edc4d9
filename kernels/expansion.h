// The triangulation as the expansion walks it: one record per crossing of an edge, with all that a
// step needs.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/triangulation.h"

namespace vfplan {

// What lies behind an edge of a triangle: a crossing (>= 0), the hull, or a wall.
using Behind = std::int32_t;
inline constexpr Behind behind_hull = -1;
inline Behind behind_wall(std::int32_t wall) { return -2 - wall; }
inline bool is_wall(Behind b) { return b <= -2; }
inline std::int32_t wall_of(Behind b) { return -2 - b; }

// Steps across an edge into the next triangle: its far vertex and, seen from the edge, its right
// and its left edge.
struct Crossing {
    double apex_x;
    double apex_y;
    Behind right;
    Behind left;
};

// Crossing 3 t + i leaves triangle t through edge i.
struct Expansion {
    Triangulation mesh;
    std::vector<Crossing> crossings;

    explicit Expansion(Triangulation triangulation);
    Behind behind(std::int32_t triangle, std::size_t edge) const;
};

}  // namespace vfplan
