// The visibility field as pixels: the colour map and the resampling behind map.png.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/grid.h"

namespace vfplan {

struct Rgb {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;
};

// Colour of cells without a value: buildings outdoors, the outside indoors.
inline constexpr Rgb no_value_colour{226, 226, 230};

// The viridis colour map, t from 0 (dark violet) to 1 (yellow); t outside is clamped.
// Differs from the published 256 colours by less than 7 of 255 steps.
Rgb viridis(double t);

// Where the pixels lie in the plane: pixel (0, 0) has its upper left corner at `north_west`.
struct PixelWindow {
    Vec2d north_west{0, 0};
    double px_per_m = 1;
    int width = 0;
    int height = 0;
};

// Row by row from the north-west, 0x00RRGGBB.
//  (1) a cell larger than a pixel is interpolated between its valid neighbours only, so that
//      colours do not fade towards walls; the border of the valid cells is antialiased
//  (2) cells smaller than a pixel are averaged, none is skipped
//  (3) pixels without a value are no_value_colour
std::vector<std::uint32_t> field_pixels(const Grid& grid, const Raster<float>& field_rad,
                                        double max_rad, const PixelWindow& window);

// Largest finite value, 0 when there is none.
double field_max(const Raster<float>& field_rad);

}  // namespace vfplan
