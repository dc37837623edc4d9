// The medial axis of the domain: average outward flux and homotopic thinning (Siddiqi et al.,
// section "Converging Lines and Joints"; SPEC section 3).
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

// 1 on the skeleton: one cell wide, 8-connected, of the same topology as the domain.
//  (1) as many components as the domain has, as many holes
//  (2) every cell lies in the domain
//  (3) the result depends on the domain alone; ties are broken by distance, row, column
// Time O(n log n) in the number of domain cells. Thread-safe.
Raster<std::uint8_t> thin(const Grid& grid, const Raster<std::uint8_t>& domain,
                          const DistanceField& distance);

// Average outward flux of the distance gradient through the eight neighbours of a cell.
double outward_flux(const Grid& grid, const DistanceField& distance, std::int64_t cell);

// Bit k is set where neighbour k is set.
unsigned neighbourhood(const Grid& grid, const Raster<std::uint8_t>& set, std::int64_t cell);

}  // namespace vfplan
