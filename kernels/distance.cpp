#include "kernels/distance.h"

#include <vector>

namespace vfplan {

void DistanceField::resize(std::int64_t cells) {
    const auto n = static_cast<std::size_t>(cells);
    squared.assign(n, 0);
    nearest_dx.assign(n, 0);
    nearest_dy.assign(n, 0);
}

void distance_columns(const Grid& grid, const Raster<std::uint8_t>& domain, std::int32_t from,
                      std::int32_t to, DistanceField& out) {
    for (std::int32_t ix = from; ix < to; ++ix) {
        std::int32_t last_outside = -1;  // the row below the grid
        for (std::int32_t iy = 0; iy < grid.ny; ++iy) {
            const auto cell = static_cast<std::size_t>(grid.id(ix, iy));
            if (domain[cell] == 0) last_outside = iy;
            out.nearest_dy[cell] = last_outside - iy;
        }
        last_outside = grid.ny;
        for (std::int32_t iy = grid.ny - 1; iy >= 0; --iy) {
            const auto cell = static_cast<std::size_t>(grid.id(ix, iy));
            if (domain[cell] == 0) last_outside = iy;
            if (last_outside - iy < -out.nearest_dy[cell]) out.nearest_dy[cell] = last_outside - iy;
        }
    }
}

// Lower envelope of the parabolas (x - column)^2 + dy(column)^2 along a row, with the columns
// just beyond the grid as parabolas of height 0. All in integers.
void distance_rows(const Grid& grid, const Raster<std::uint8_t>& domain, std::int32_t from,
                   std::int32_t to, DistanceField& inout) {
    const std::int32_t nx = grid.nx;
    std::vector<std::int64_t> height(static_cast<std::size_t>(nx) + 2);
    std::vector<std::int32_t> dy(height.size(), 0);
    std::vector<std::int32_t> apex(height.size());    // column of each parabola of the envelope
    std::vector<std::int64_t> begins(height.size());  // first x at which it is the lowest
    for (std::int32_t iy = from; iy < to; ++iy) {
        height.front() = height.back() = 0;
        for (std::int32_t ix = 0; ix < nx; ++ix) {
            const auto k = static_cast<std::size_t>(ix) + 1;
            dy[k] = inout.nearest_dy[static_cast<std::size_t>(grid.id(ix, iy))];
            height[k] = static_cast<std::int64_t>(dy[k]) * dy[k];
        }
        const auto h = [&](std::int32_t column) {
            return height[static_cast<std::size_t>(column) + 1];
        };
        // First x at which the parabola of column q is strictly lower than that of p < q.
        const auto overtakes = [&](std::int32_t p, std::int32_t q) {
            const std::int64_t n =
                h(q) - h(p) + static_cast<std::int64_t>(q) * q - static_cast<std::int64_t>(p) * p;
            const std::int64_t d = 2 * static_cast<std::int64_t>(q - p);
            return (n >= 0 ? n / d : -((-n + d - 1) / d)) + 1;
        };
        std::size_t top = 0;
        apex[0] = -1;
        begins[0] = -1;
        for (std::int32_t q = 0; q <= nx; ++q) {
            std::int64_t x = overtakes(apex[top], q);
            while (top > 0 && x <= begins[top]) {
                --top;
                x = overtakes(apex[top], q);
            }
            if (x > nx) continue;
            if (x <= begins[top]) {  // lower than the first one from the start
                apex[top] = q;
                continue;
            }
            ++top;
            apex[top] = q;
            begins[top] = x;
        }
        std::size_t part = 0;
        for (std::int32_t ix = 0; ix < nx; ++ix) {
            while (part < top && begins[part + 1] <= ix) ++part;
            const auto cell = static_cast<std::size_t>(grid.id(ix, iy));
            const std::int32_t column = apex[part];
            const std::int64_t dx = column - ix;
            inout.nearest_dx[cell] = static_cast<std::int32_t>(dx);
            inout.squared[cell] = static_cast<std::int32_t>(dx * dx + h(column));
            inout.nearest_dy[cell] = dy[static_cast<std::size_t>(column) + 1];
            if (domain[cell] == 0) {
                inout.squared[cell] = inout.nearest_dx[cell] = inout.nearest_dy[cell] = 0;
            }
        }
    }
}

}  // namespace vfplan
