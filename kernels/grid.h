// The regular grid of cells over a site, and rasters on it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/vec.h"

namespace vfplan {

// nx x ny square cells; cell (ix, iy) has its centre at origin + cell_m * (ix + 1/2, iy + 1/2).
// Cells are numbered row by row from the south-west: id = iy * nx + ix.
struct Grid {
    Vec2d origin{0, 0};  // south-west corner, site frame
    double cell_m = 1;
    std::int32_t nx = 0;
    std::int32_t ny = 0;

    std::int64_t size() const { return static_cast<std::int64_t>(nx) * ny; }
    std::int64_t id(std::int32_t ix, std::int32_t iy) const {
        return static_cast<std::int64_t>(iy) * nx + ix;
    }
    std::int32_t ix(std::int64_t id) const { return static_cast<std::int32_t>(id % nx); }
    std::int32_t iy(std::int64_t id) const { return static_cast<std::int32_t>(id / nx); }
    bool inside(std::int32_t ix, std::int32_t iy) const {
        return ix >= 0 && iy >= 0 && ix < nx && iy < ny;
    }
    Vec2d centre(std::int64_t cell) const {
        return {origin.x() + cell_m * (ix(cell) + 0.5), origin.y() + cell_m * (iy(cell) + 0.5)};
    }
};

// Cells (ix, iy) with x_begin <= ix < x_end and y_begin <= iy < y_end.
struct Window {
    std::int32_t x_begin = 0;
    std::int32_t y_begin = 0;
    std::int32_t x_end = 0;
    std::int32_t y_end = 0;

    bool contains(std::int32_t x, std::int32_t y) const {
        return x >= x_begin && x < x_end && y >= y_begin && y < y_end;
    }
    std::int64_t size() const {
        return static_cast<std::int64_t>(x_end - x_begin) * (y_end - y_begin);
    }
    // This much more on every side, as far as the grid goes.
    Window grown(std::int32_t cells, const Grid& grid) const {
        return {std::max(0, x_begin - cells), std::max(0, y_begin - cells),
                std::min(grid.nx, x_end + cells), std::min(grid.ny, y_end + cells)};
    }
};

// The cells that lie in both; of no extent where there are none.
inline Window shared(const Window& a, const Window& b) {
    return {std::max(a.x_begin, b.x_begin), std::max(a.y_begin, b.y_begin),
            std::min(a.x_end, b.x_end), std::min(a.y_end, b.y_end)};
}

// The cells of a window as a grid of their own. Rows and columns keep their order, so what is
// decided by the order of cells is decided alike.
inline Grid part_of(const Grid& grid, const Window& w) {
    return {{grid.origin.x() + grid.cell_m * w.x_begin, grid.origin.y() + grid.cell_m * w.y_begin},
            grid.cell_m,
            w.x_end - w.x_begin,
            w.y_end - w.y_begin};
}

// One value per cell, in the order of Grid::id.
template <class T>
using Raster = std::vector<T>;

}  // namespace vfplan
