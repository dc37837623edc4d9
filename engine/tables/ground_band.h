// A band of rows of the grid: what of it is ground, and where on that a station may stand.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/config/options.h"
#include "kernels/grid.h"
#include "kernels/wall.h"

namespace vfplan {

// What decides about a band of rows. `kept_out`: where the user lets no station stand.
struct GroundBand {
    std::vector<Border> free;
    std::vector<Border> kept_out;
    std::vector<Wall> walls;

    GroundBand(const GroundOptions& options, const Site& site, const std::vector<Border>& kept_out,
               const Grid& rows);
};

// 1 for cells of a window: which are ground, and where on it a station may stand: off the walls by
// the clearance, or in the middle of a passage (kernels/passages.h), and not kept out.
struct Ground {
    Raster<std::uint8_t> free;
    Raster<std::uint8_t> standable;
};

// `window`: some columns of the band's rows. The same cell is decided alike in every window, but
// for the rounding of its centre. Memory: 24 bytes for each cell of the window with what the
// clearance reaches around it.
Ground ground_of(const GroundOptions& options, const GroundBand& band, const Grid& window);

}  // namespace vfplan
