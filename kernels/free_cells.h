// Which cells a station can stand in.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/grid.h"
#include "kernels/wall.h"

namespace vfplan {

// A grid over `extent`. Walls lie on multiples of snap_m; the grid starts a quarter of a snap
// beside them, so that no cell centre lies on a wall that runs along an axis.
Grid make_grid(const Box& extent, double cell_m, double snap_m);

// 1 where the cell's centre lies inside an odd number of rings, else 0.
// Time O(cells + edges x rows they span).
Raster<std::uint8_t> free_cells(const Grid& grid, const std::vector<Ring>& free_region);

// 1 for free cells that a wall separates from one of their eight free neighbours: walls thinner
// than a cell would otherwise be invisible to everything that walks from cell to cell.
Raster<std::uint8_t> cut_cells(const Grid& grid, const Raster<std::uint8_t>& free,
                               const std::vector<Wall>& walls);

}  // namespace vfplan
