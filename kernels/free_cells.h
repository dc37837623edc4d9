// Which cells a station can stand in.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "kernels/grid.h"
#include "kernels/wall.h"

namespace vfplan {

// A grid over `extent`. Walls lie on multiples of snap_m; the grid starts a quarter of a snap
// beside them, so that for cells of an even number of snaps no centre lies on a wall that runs
// along an axis.
Grid make_grid(const Box& extent, double cell_m, double snap_m);

// True when ab and cd have a point in common (touching counts, lying in one line does not).
bool segments_meet(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d);

// True where a border of closed rings surrounds a point an odd number of times.
bool inside_odd(const std::vector<Border>& border, const Vec2d& p);

// 1 where a border surrounds the cell's centre an odd number of times, else 0. What lies beyond the
// grid to the east, north or south may be left out of the border. Time O(cells + pieces of border x
// rows they span).
Raster<std::uint8_t> free_cells(const Grid& grid, const std::vector<Border>& border);

// A centre that lies this near to a wall lies on it: which side it is on is for rounding to say.
inline constexpr double on_wall_m = 1e-8;

// 1 for cells whose centre lies on a wall. Time O(walls x rows they span).
Raster<std::uint8_t> cells_on_walls(const Grid& grid, const std::vector<Wall>& walls);

// From a place to the nearest of a wall.
inline Vec2d way_to(const Wall& wall, const Vec2d& at) {
    const Vec2d e = wall.b - wall.a;
    const Vec2d p = at - wall.a;
    return std::clamp(p.dot(e) / e.squaredNorm(), 0.0, 1.0) * e - p;
}

// The row or column of something so far from the grid's origin; the nearest one beyond the grid.
inline std::int32_t cell_index(double metres, double cell_m, std::int32_t count) {
    const double i = std::floor(metres / cell_m);
    return static_cast<std::int32_t>(std::clamp(i, 0.0, static_cast<double>(count - 1)));
}

// Calls f(cell, way to the wall) for cells that are wanted(cell) and whose centre is nearer to a
// wall than the reach.
template <class Wanted, class F>
void each_cell_near(const Grid& grid, const Wall& wall, double reach_m, Wanted&& wanted, F&& f) {
    const Vec2d reach(reach_m, reach_m);
    const Vec2d lo = wall.a.cwiseMin(wall.b) - reach - grid.origin;
    const Vec2d hi = wall.a.cwiseMax(wall.b) + reach - grid.origin;
    const std::int32_t x_begin = cell_index(lo.x(), grid.cell_m, grid.nx);
    const std::int32_t x_last = cell_index(hi.x(), grid.cell_m, grid.nx);
    const std::int32_t y_last = cell_index(hi.y(), grid.cell_m, grid.ny);
    for (std::int32_t iy = cell_index(lo.y(), grid.cell_m, grid.ny); iy <= y_last; ++iy) {
        for (std::int32_t ix = x_begin; ix <= x_last; ++ix) {
            const std::int64_t cell = grid.id(ix, iy);
            if (!wanted(cell)) continue;
            const Vec2d way = way_to(wall, grid.centre(cell));
            if (way.norm() < reach_m) f(cell, way);
        }
    }
}

// 1 for cells whose centre is nearer to a wall than clearance_m; all 0 for a clearance of 0.
Raster<std::uint8_t> cells_near_walls(const Grid& grid, const std::vector<Wall>& walls,
                                      double clearance_m);

// The eight neighbours of a cell, counter-clockwise from east; even ones share an edge.
inline constexpr std::int32_t around_dx[8] = {1, 1, 0, -1, -1, -1, 0, 1};
inline constexpr std::int32_t around_dy[8] = {0, 1, 1, 1, 0, -1, -1, -1};

// Bit k of a free cell is set when a wall separates its centre from that of its free neighbour k:
// walls thinner than a cell would otherwise be invisible to all that walks from cell to cell.
// Each step belongs to the cell that has it as one of its first four; only steps of `owners` are
// looked at, and noted at both ends.
Raster<std::uint8_t> closed_steps(const Grid& grid, const Raster<std::uint8_t>& free,
                                  const std::vector<Wall>& walls, const Window& owners);

}  // namespace vfplan
