// The medial axis of the domain: average outward flux and homotopic thinning (Siddiqi et al.;
// docs/method.md 3).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/distance.h"
#include "kernels/free_cells.h"
#include "kernels/grid.h"

namespace vfplan {

// Below this average outward flux a line's end belongs to the axis. A corner of 90 degrees gives
// -0.45, a wall that bends by 30 degrees -0.16.
inline constexpr double flux_of_an_end = -0.3;

// What is known of a cell while only a part of the whole is looked at.
enum class Cell : std::uint8_t { absent = 0, present = 1, unknown = 2 };

// A part of a larger grid: where it lies, and on which sides there is more.
struct PartOfGrid {
    std::int32_t x0 = 0;  // column and row of its first cell
    std::int32_t y0 = 0;
    bool more[4] = {false, false, false, false};  // west, south, east, north
};

// The skeleton: one cell wide, 8-connected, of the same topology as the domain. Cells go level by
// level, the nearest to the domain's edge first; on a level in rounds, in each round the cells of
// even or odd column and row in turn, so that no two neighbours go at once and order plays no part.
//  (1) as many components as the domain has, as many holes
//  (2) every cell present lies in the domain
//  (3) the result depends on the domain alone
//  (4) of a part, what is present or absent is so in the whole grid's skeleton too: a cell whose
//      fate hangs on what lies beyond is unknown. Further inside than the distance to the domain's
//      edge and a few cells more, hardly any is.
// Time O(n log n) in the number of domain cells. Thread-safe.
std::vector<Cell> thin(const Grid& grid, const Raster<std::uint8_t>& domain,
                       const DistanceField& distance, const PartOfGrid& part = {});

// Average outward flux of the distance gradient through the eight neighbours of a cell.
double outward_flux(const Grid& grid, const DistanceField& distance, std::int64_t cell);

}  // namespace vfplan
