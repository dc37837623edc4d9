#include "kernels/free_cells.h"

#include <algorithm>
#include <cmath>

namespace vfplan {

Grid make_grid(const Box& extent, double cell_m, double snap_m) {
    Grid grid;
    grid.cell_m = cell_m;
    grid.origin = extent.min - Vec2d(snap_m / 4, snap_m / 4);
    const Vec2d cells = (extent.max - grid.origin) / cell_m;
    grid.nx = static_cast<std::int32_t>(std::ceil(cells.x() - 1e-9));
    grid.ny = static_cast<std::int32_t>(std::ceil(cells.y() - 1e-9));
    return grid;
}

bool segments_meet(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
    const double abc = orient(a, b, c);
    const double abd = orient(a, b, d);
    const double cda = orient(c, d, a);
    const double cdb = orient(c, d, b);
    if (abc == 0 && abd == 0) return false;  // along the wall: nothing is separated
    return abc * abd <= 0 && cda * cdb <= 0;
}

bool inside_odd(const std::vector<Border>& border, const Vec2d& p) {
    bool inside = false;
    for (const auto& [a, b] : border) {
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if (p.x() < a.x() + (b.x() - a.x()) * ((p.y() - a.y()) / (b.y() - a.y()))) inside = !inside;
    }
    return inside;
}

Raster<std::uint8_t> free_cells(const Grid& grid, const std::vector<Border>& border) {
    // Every piece flips all cells to the right of it in the rows whose centre it passes.
    Raster<std::uint8_t> flips(static_cast<std::size_t>(grid.size()), 0);
    for (auto [a, b] : border) {
        if (a.y() == b.y()) continue;
        if (a.y() > b.y()) std::swap(a, b);
        const double from = (a.y() - grid.origin.y()) / grid.cell_m - 0.5;
        const double to = (b.y() - grid.origin.y()) / grid.cell_m - 0.5;
        const auto row_from = static_cast<std::int32_t>(std::max(0.0, std::ceil(from)));
        const auto row_to =
            static_cast<std::int32_t>(std::min(static_cast<double>(grid.ny), std::ceil(to)));
        for (std::int32_t iy = row_from; iy < row_to; ++iy) {
            const double y = grid.origin.y() + grid.cell_m * (iy + 0.5);
            const double x = a.x() + (b.x() - a.x()) * ((y - a.y()) / (b.y() - a.y()));
            const double column = std::ceil((x - grid.origin.x()) / grid.cell_m - 0.5);
            if (column >= grid.nx) continue;
            const auto ix = static_cast<std::int32_t>(std::max(0.0, column));
            flips[static_cast<std::size_t>(grid.id(ix, iy))] ^= 1;
        }
    }
    for (std::int32_t iy = 0; iy < grid.ny; ++iy) {
        std::uint8_t inside = 0;
        for (std::int32_t ix = 0; ix < grid.nx; ++ix) {
            auto& cell = flips[static_cast<std::size_t>(grid.id(ix, iy))];
            inside ^= cell;
            cell = inside;
        }
    }
    return flips;
}

Raster<std::uint8_t> cells_on_walls(const Grid& grid, const std::vector<Wall>& walls) {
    Raster<std::uint8_t> on(static_cast<std::size_t>(grid.size()), 0);
    const double c = grid.cell_m;
    const auto first_from = [&](double v, std::int32_t n) {
        return static_cast<std::int32_t>(std::clamp(std::ceil(v / c - 0.5), 0.0, double(n)));
    };
    for (const Wall& wall : walls) {
        const Vec2d a = wall.a - grid.origin;
        const Vec2d e = wall.b - wall.a;
        const double length = wall.length_m();
        const double low = std::min(0.0, e.y()) + a.y();
        const double high = std::max(0.0, e.y()) + a.y();
        const std::int32_t row_end = first_from(high + on_wall_m, grid.ny);
        for (std::int32_t iy = first_from(low - on_wall_m, grid.ny); iy < row_end; ++iy) {
            // The stretch of the row that is near enough, a little more at the wall's ends.
            const double y = c * (iy + 0.5);
            double from = std::min(0.0, e.x()) + a.x() - on_wall_m;
            double to = std::max(0.0, e.x()) + a.x() + on_wall_m;
            if (e.y() != 0) {
                const double x = a.x() + (y - a.y()) / e.y() * e.x();
                const double reach = on_wall_m * length / std::abs(e.y());
                from = std::max(from, x - reach);
                to = std::min(to, x + reach);
            }
            const std::int32_t column_end = first_from(to, grid.nx);
            for (std::int32_t ix = first_from(from, grid.nx); ix < column_end; ++ix) {
                on[static_cast<std::size_t>(grid.id(ix, iy))] = 1;
            }
        }
    }
    return on;
}

Raster<std::uint8_t> cells_near_walls(const Grid& grid, const std::vector<Wall>& walls,
                                      double clearance_m) {
    Raster<std::uint8_t> near(static_cast<std::size_t>(grid.size()), 0);
    if (clearance_m <= 0) return near;
    for (const Wall& wall : walls) {
        each_cell_near(
            grid, wall, clearance_m, [](std::int64_t) { return true; },
            [&](std::int64_t cell, const Vec2d&) { near[static_cast<std::size_t>(cell)] = 1; });
    }
    return near;
}

Raster<std::uint8_t> closed_steps(const Grid& grid, const Raster<std::uint8_t>& free,
                                  const std::vector<Wall>& walls, const Window& owners) {
    Raster<std::uint8_t> closed(free.size(), 0);
    for (const Wall& wall : walls) {
        const Vec2d a = wall.a - grid.origin;
        const Vec2d b = wall.b - grid.origin;
        const double c = grid.cell_m;
        const std::int32_t row_from = cell_index(std::min(a.y(), b.y()) - 1.5 * c, c, grid.ny);
        const std::int32_t row_to = cell_index(std::max(a.y(), b.y()) + 1.5 * c, c, grid.ny);
        for (std::int32_t iy = std::max(row_from, owners.y_begin);
             iy <= std::min(row_to, owners.y_end - 1); ++iy) {
            // The columns that the wall passes within 1.5 cells of this row.
            const double lo = c * (iy - 1);
            const double hi = c * (iy + 2);
            double t0 = 0;
            double t1 = 1;
            if (a.y() != b.y()) {
                const double u = (lo - a.y()) / (b.y() - a.y());
                const double v = (hi - a.y()) / (b.y() - a.y());
                t0 = std::clamp(std::min(u, v), 0.0, 1.0);
                t1 = std::clamp(std::max(u, v), 0.0, 1.0);
            }
            const double x0 = a.x() + t0 * (b.x() - a.x());
            const double x1 = a.x() + t1 * (b.x() - a.x());
            const std::int32_t col_from = cell_index(std::min(x0, x1) - 1.5 * c, c, grid.nx);
            const std::int32_t col_to = cell_index(std::max(x0, x1) + 1.5 * c, c, grid.nx);
            for (std::int32_t ix = std::max(col_from, owners.x_begin);
                 ix <= std::min(col_to, owners.x_end - 1); ++ix) {
                const auto here = static_cast<std::size_t>(grid.id(ix, iy));
                if (free[here] == 0) continue;
                for (unsigned k = 0; k < 4; ++k) {  // the other four are their neighbours'
                    const std::int32_t x = ix + around_dx[k];
                    const std::int32_t y = iy + around_dy[k];
                    if (!grid.inside(x, y)) continue;
                    const auto there = static_cast<std::size_t>(grid.id(x, y));
                    if (free[there] == 0 || (closed[here] >> k & 1U) != 0) continue;
                    if (segments_meet(wall.a, wall.b, grid.centre(static_cast<std::int64_t>(here)),
                                      grid.centre(static_cast<std::int64_t>(there)))) {
                        closed[here] = static_cast<std::uint8_t>(closed[here] | 1U << k);
                        closed[there] = static_cast<std::uint8_t>(closed[there] | 1U << (k + 4));
                    }
                }
            }
        }
    }
    return closed;
}

}  // namespace vfplan
