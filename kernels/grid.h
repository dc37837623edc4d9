// The regular grid of cells over a site, and rasters on it.
#pragma once

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
};

// One value per cell, in the order of Grid::id.
template <class T>
using Raster = std::vector<T>;

}  // namespace vfplan
