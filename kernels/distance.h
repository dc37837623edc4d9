// Exact Euclidean distance to the nearest cell outside a domain (two passes of parabolas).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/grid.h"

namespace vfplan {

// Where the nearest outside cell lies, as an offset from the cell, and how far, in cells.
// Everything beyond the grid is outside. Among equally near cells the one with the smallest
// column, then row, is taken.
struct DistanceField {
    Raster<std::int32_t> squared;  // 0 outside the domain
    Raster<std::int32_t> nearest_dx;
    Raster<std::int32_t> nearest_dy;

    void resize(std::int64_t cells);
};

// The two passes; the first must be done for all columns before the second.
// Thread-safe for disjoint columns (rows).
void distance_columns(const Grid& grid, const Raster<std::uint8_t>& domain, std::int32_t from,
                      std::int32_t to, DistanceField& out);
void distance_rows(const Grid& grid, const Raster<std::uint8_t>& domain, std::int32_t from,
                   std::int32_t to, DistanceField& inout);

}  // namespace vfplan
