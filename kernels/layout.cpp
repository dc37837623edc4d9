#include "kernels/layout.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"

namespace vfplan {
namespace {

Window square(const Grid& grid, std::int64_t number, std::int32_t columns, std::int32_t side) {
    const auto x = static_cast<std::int32_t>(number % columns) * side;
    const auto y = static_cast<std::int32_t>(number / columns) * side;
    return {x, y, std::min(x + side, grid.nx), std::min(y + side, grid.ny)};
}

std::vector<std::int64_t> squares_in(const Window& w, std::int32_t columns, std::int32_t side) {
    std::vector<std::int64_t> out;
    for (std::int32_t y = w.y_begin / side; y <= (w.y_end - 1) / side; ++y) {
        for (std::int32_t x = w.x_begin / side; x <= (w.x_end - 1) / side; ++x) {
            out.push_back(std::int64_t{y} * columns + x);
        }
    }
    return out;
}

std::int32_t index_of(double metres, double side_m, std::int32_t count) {
    return static_cast<std::int32_t>(
        std::clamp(std::floor(metres / side_m), 0.0, static_cast<double>(count - 1)));
}

// Calls f(patch) for the patches that come within reach of a wall's box.
template <class F>
void each_near(const Layout& layout, const Wall& wall, double reach_m, F&& f) {
    const Vec2d reach(reach_m, reach_m);
    const double side = layout.grid.cell_m * layout.patch_cells;
    const Vec2d lo = wall.a.cwiseMin(wall.b) - reach - layout.grid.origin;
    const Vec2d hi = wall.a.cwiseMax(wall.b) + reach - layout.grid.origin;
    for (std::int32_t y = index_of(lo.y(), side, layout.patch_rows());
         y <= index_of(hi.y(), side, layout.patch_rows()); ++y) {
        for (std::int32_t x = index_of(lo.x(), side, layout.patch_columns());
             x <= index_of(hi.x(), side, layout.patch_columns()); ++x) {
            f(std::int64_t{y} * layout.patch_columns() + x);
        }
    }
}

}  // namespace

Window Layout::patch_window(std::int64_t patch) const {
    return square(grid, patch, patch_columns(), patch_cells);
}

Window Layout::tile_window(std::int64_t tile) const {
    return square(grid, tile, tile_columns(), tile_cells);
}

std::int64_t Layout::cell_at(const Vec2d& point) const {
    return grid.id(index_of(point.x() - grid.origin.x(), grid.cell_m, grid.nx),
                   index_of(point.y() - grid.origin.y(), grid.cell_m, grid.ny));
}

Vec2d Layout::patch_origin(std::int64_t patch) const {
    const Window w = patch_window(patch);
    return part_of(grid, w).origin;
}

std::vector<std::int64_t> Layout::patches_in(const Window& window) const {
    return squares_in(window, patch_columns(), patch_cells);
}

std::vector<std::int64_t> Layout::tiles_in(const Window& window) const {
    return squares_in(window, tile_columns(), tile_cells);
}

double Layout::largest_window_cells(double margin) const {
    // Of the tile in the middle.
    const auto along = [&](std::int32_t cells, std::int32_t tiles) {
        const double begin = std::floor((tiles - 1) / 2.0) * tile_cells;
        return std::min<double>(cells, begin + tile_cells + margin) - std::max(0.0, begin - margin);
    };
    return along(grid.nx, tile_columns()) * along(grid.ny, tile_rows());
}

double Layout::largest_patch_cells() const {
    return static_cast<double>(std::min(patch_cells, grid.nx)) * std::min(patch_cells, grid.ny);
}

Layout make_layout(const Grid& grid, double range_max_m, std::int64_t tile_cells) {
    constexpr double step = 32;  // cells: the windows that threads take
    const double wanted = std::ceil(6 * range_max_m / grid.cell_m / step) * step;
    const double whole = std::ceil(std::max(grid.nx, grid.ny) / step) * step;
    Layout out;
    out.grid = grid;
    out.patch_cells = static_cast<std::int32_t>(std::max(step, std::min(wanted, whole)));
    out.tile_cells = static_cast<std::int32_t>(tile_cells);
    return out;
}

Layout in_blocks(Layout layout, std::int32_t least_cells) {
    constexpr std::int32_t step = 4;
    layout.tile_cells = std::max(layout.tile_cells, (least_cells + step - 1) / step * step);
    return layout;
}

double eye_margin_m(double partition_m) { return partition_m + 1; }

double wall_reach_m(double range_max_m, double partition_m, double snap_m) {
    return range_max_m + eye_margin_m(partition_m) + snap_m;
}

NearWalls near_walls(const Layout& layout, const std::vector<Wall>& walls, double reach_m) {
    NearWalls out;
    out.begin.assign(idx(layout.patches()) + 1, 0);
    for (const Wall& wall : walls) {
        each_near(layout, wall, reach_m, [&](std::int64_t p) { ++out.begin[idx(p) + 1]; });
    }
    for (std::size_t p = 0; p + 1 < out.begin.size(); ++p) out.begin[p + 1] += out.begin[p];
    out.wall.resize(idx(out.begin.back()));
    std::vector<std::int64_t> next(out.begin.begin(), out.begin.end() - 1);
    for (std::size_t w = 0; w < walls.size(); ++w) {
        each_near(layout, walls[w], reach_m, [&](std::int64_t p) {
            out.wall[idx(next[idx(p)]++)] = static_cast<std::int32_t>(w);
        });
    }
    return out;
}

}  // namespace vfplan
