// Doorways for tripods: places too narrow for the clearance in which a station may stand all the
// same, because they lie between places where it has its clearance.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/grid.h"
#include "kernels/wall.h"

namespace vfplan {

// How far from the middle of a passage one looks for the places that it joins: through walls half a
// metre thick with the clearance of a tripod.
inline double passage_reach_m(double clearance_m) { return 3 * clearance_m; }

// 1 for cells that are free and near and in the middle of a passage: as far, to a cell, from one
// wall as from another, the two places apart by the clearance or more, and in sight of free cells
// that are not near, within the reach, on both sides of the line from wall to wall (at most 60
// degrees off its normal). `near`: as cells_near_walls() with this clearance says. Cells within the
// reach of the grid's border are decided as if nothing was free beyond it. Time O(walls x cells
// that the clearance reaches).
Raster<std::uint8_t> cells_in_passages(const Grid& grid, const Raster<std::uint8_t>& free,
                                       const Raster<std::uint8_t>& near,
                                       const std::vector<Wall>& walls, double clearance_m);

}  // namespace vfplan
