#include "io/exports/map_field.h"

#include <algorithm>
#include <cmath>

namespace vfplan {
namespace {

// Every 17th of the 256 viridis colours.
constexpr Rgb viridis_anchors[16] = {
    {68, 1, 84},    {72, 26, 108},  {71, 47, 125},  {65, 68, 135},  {57, 86, 140},  {49, 104, 142},
    {42, 120, 142}, {35, 136, 142}, {31, 152, 139}, {34, 168, 132}, {53, 183, 121}, {84, 197, 104},
    {122, 209, 81}, {165, 219, 54}, {210, 226, 27}, {253, 231, 37}};

std::uint8_t mix(std::uint8_t a, std::uint8_t b, double t) {
    return static_cast<std::uint8_t>(a + (b - a) * t + 0.5);
}

Rgb mix(const Rgb& a, const Rgb& b, double t) {
    return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

std::uint32_t pack(const Rgb& c) {
    return (static_cast<std::uint32_t>(c.r) << 16) | (static_cast<std::uint32_t>(c.g) << 8) | c.b;
}

// Sum of values and share of valid cells per block of cells; blocks are single cells unless
// cells are smaller than pixels.
struct Blocks {
    int nx = 0;
    int ny = 0;
    double size_m = 1;
    std::vector<float> weight;  // share of valid cells, 0..1
    std::vector<float> value;   // mean of the valid cells times weight

    std::size_t id(int ix, int iy) const {
        return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx) +
               static_cast<std::size_t>(ix);
    }
};

Blocks make_blocks(const Grid& grid, const Raster<float>& field, double px_per_m) {
    const int side =
        std::max(1, static_cast<int>(std::ceil(1.0 / (grid.cell_m * px_per_m) - 0.01)));
    Blocks b;
    b.nx = (grid.nx + side - 1) / side;
    b.ny = (grid.ny + side - 1) / side;
    b.size_m = grid.cell_m * side;
    b.weight.assign(b.id(0, b.ny), 0.0F);
    b.value.assign(b.weight.size(), 0.0F);
    for (int y = 0; y < b.ny; ++y) {
        for (int x = 0; x < b.nx; ++x) {
            int cells = 0;
            int valid = 0;
            double sum = 0;
            for (int iy = y * side; iy < std::min((y + 1) * side, grid.ny); ++iy) {
                for (int ix = x * side; ix < std::min((x + 1) * side, grid.nx); ++ix) {
                    const float v = field[static_cast<std::size_t>(grid.id(ix, iy))];
                    ++cells;
                    if (std::isfinite(v)) {
                        ++valid;
                        sum += static_cast<double>(v);
                    }
                }
            }
            b.weight[b.id(x, y)] = static_cast<float>(valid) / static_cast<float>(cells);
            b.value[b.id(x, y)] = static_cast<float>(sum / cells);
        }
    }
    return b;
}

}  // namespace

Rgb viridis(double t) {
    const double at = std::clamp(std::isfinite(t) ? t : 0.0, 0.0, 1.0) * 15;
    const int i = std::min(static_cast<int>(at), 14);
    return mix(viridis_anchors[i], viridis_anchors[i + 1], at - i);
}

double field_max(const Raster<float>& field_rad) {
    float top = 0;
    for (const float v : field_rad) {
        if (std::isfinite(v)) top = std::max(top, v);
    }
    return static_cast<double>(top);
}

std::vector<std::uint32_t> field_pixels(const Grid& grid, const Raster<float>& field_rad,
                                        double max_rad, const PixelWindow& window) {
    const auto width = static_cast<std::size_t>(window.width);
    std::vector<std::uint32_t> out(width * static_cast<std::size_t>(window.height),
                                   pack(no_value_colour));
    if (grid.nx <= 0 || grid.ny <= 0 || max_rad <= 0) return out;
    const Blocks blocks = make_blocks(grid, field_rad, window.px_per_m);
    const double px_per_block = blocks.size_m * window.px_per_m;
    const double grid_width_m = grid.nx * grid.cell_m;
    const double grid_height_m = grid.ny * grid.cell_m;

    for (int row = 0; row < window.height; ++row) {
        const double y_m = window.north_west.y() - (row + 0.5) / window.px_per_m - grid.origin.y();
        if (y_m < 0 || y_m >= grid_height_m) continue;
        const double gy = y_m / blocks.size_m - 0.5;
        const int y0 = static_cast<int>(std::floor(gy));
        for (int col = 0; col < window.width; ++col) {
            const double x_m =
                window.north_west.x() + (col + 0.5) / window.px_per_m - grid.origin.x();
            if (x_m < 0 || x_m >= grid_width_m) continue;
            const double gx = x_m / blocks.size_m - 0.5;
            const int x0 = static_cast<int>(std::floor(gx));
            double weight = 0;
            double value = 0;
            for (int dy = 0; dy < 2; ++dy) {
                const double wy = dy == 0 ? 1 - (gy - y0) : gy - y0;
                const int iy = std::clamp(y0 + dy, 0, blocks.ny - 1);
                for (int dx = 0; dx < 2; ++dx) {
                    const double w = wy * (dx == 0 ? 1 - (gx - x0) : gx - x0);
                    const std::size_t id = blocks.id(std::clamp(x0 + dx, 0, blocks.nx - 1), iy);
                    weight += w * static_cast<double>(blocks.weight[id]);
                    value += w * static_cast<double>(blocks.value[id]);
                }
            }
            const double alpha = std::clamp((weight - 0.5) * px_per_block + 0.5, 0.0, 1.0);
            if (alpha <= 0 || weight <= 0) continue;
            const Rgb colour = viridis(value / weight / max_rad);
            out[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(col)] =
                pack(mix(no_value_colour, colour, alpha));
        }
    }
    return out;
}

}  // namespace vfplan
