// The one planar subdivision that a site's walls, free sides and free ground are read from
// (docs/method.md 1).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "io/site/linework.h"
#include "kernels/triangulation.h"

namespace vfplan {

// Linework noded, its faces cut into triangles, and for each what surrounds it. Vertices of the
// triangles are in lattice steps (snaps), so that they are exact.
struct Subdivision {
    Noded noded;
    std::vector<std::optional<WallClass>> cls;  // by edge: window before wall, door, obstacle
    std::vector<bool> line_along;               // by edge: a line runs along it, not areas alone
    Triangulation triangles;
    std::vector<Kinds> kinds;                              // by triangle
    std::vector<std::array<std::int32_t, 2>> triangle_at;  // by edge and Side of a -> b
};

// The triangles reach `margin_m` beyond the linework, or a little if it is 0. Throws InputError
// when the linework spreads too far.
Subdivision subdivide(const Linework& linework, double margin_m = 0);

// A place for every polygon that crosses itself.
std::vector<Vec2d> self_crossings(const Linework& linework, const Noded& noded);

// Adds what noding did to the pieces of linework.
void count_edges(const Linework& linework, const Noded& noded, CleaningCounts& counts);

// What becomes of an edge.
struct EdgeUse {
    bool kept = false;
    std::array<bool, 2> free{};  // by Side
    friend bool operator==(const EdgeUse&, const EdgeUse&) = default;
};

// Gives classes to the edges that areas within walls make: a wall's end in an opening is a wall,
// its face in a window is a window.
void settle_openings(Subdivision& s);

// Which edges are walls, by edge; free sides are left to the caller. An edge is left out when both
// its sides are taken (counted as inside solids) or in an opening (counted as opened), and when
// areas alone make it and it parts nothing: what an area thinner than the snap leaves, or the
// border of two outlines (counted as slivers).
std::vector<EdgeUse> walls_among(const Subdivision& s, CleaningCounts& counts);

// The walls of a subdivision. Neighbours in one straight line, of one class and use, that meet
// nothing else become one. Walls come in no order that means anything (see sort_walls()).
std::vector<Wall> walls_of(const Subdivision& s, double snap_m, const std::vector<EdgeUse>& use,
                           CleaningCounts& counts);

// By square of 256 m, then by their ends: walls near each other have near numbers.
void sort_walls(std::vector<Wall>& walls);

// Of the triangles that `counts` says yes to. Exact but for one rounding.
double area_m2(const Subdivision& s, double snap_m,
               const std::function<bool(std::int32_t triangle)>& counts);

}  // namespace vfplan
