// Rasters drawn as text, and the slow, obvious measures of them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "kernels/distance.h"
#include "kernels/free_cells.h"
#include "kernels/grid.h"
#include "kernels/ridges.h"
#include "kernels/skeleton.h"

namespace vfplan::test {

struct Picture {
    Grid grid;
    Raster<std::uint8_t> set;

    std::uint8_t& at(std::int32_t ix, std::int32_t iy) {
        return set[static_cast<std::size_t>(grid.id(ix, iy))];
    }
    bool has(std::int32_t ix, std::int32_t iy) const {
        return grid.inside(ix, iy) && set[static_cast<std::size_t>(grid.id(ix, iy))] != 0;
    }
};

inline Picture blank(std::int32_t nx, std::int32_t ny, std::uint8_t value = 0) {
    Picture p;
    p.grid.nx = nx;
    p.grid.ny = ny;
    p.set.assign(static_cast<std::size_t>(p.grid.size()), value);
    return p;
}

// '#' is set; the first line is row 0.
inline Picture draw(const std::vector<std::string>& lines) {
    Picture p = blank(static_cast<std::int32_t>(lines.at(0).size()),
                      static_cast<std::int32_t>(lines.size()));
    for (std::size_t y = 0; y < lines.size(); ++y) {
        for (std::size_t x = 0; x < lines[y].size(); ++x) {
            p.at(static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)) = lines[y][x] == '#';
        }
    }
    return p;
}

inline std::vector<std::string> text(const Picture& p) {
    std::vector<std::string> lines;
    for (std::int32_t y = 0; y < p.grid.ny; ++y) {
        lines.emplace_back();
        for (std::int32_t x = 0; x < p.grid.nx; ++x) lines.back() += p.has(x, y) ? '#' : '.';
    }
    return lines;
}

inline DistanceField distance_of(const Picture& p) {
    DistanceField d;
    d.resize(p.grid.size());
    distance_columns(p.grid, p.set, 0, p.grid.nx, d);
    distance_rows(p.grid, p.set, 0, p.grid.ny, d);
    return d;
}

// Bit k: the neighbour k of a cell is set.
inline unsigned neighbourhood(const Picture& p, std::int64_t cell) {
    unsigned bits = 0;
    for (unsigned k = 0; k < 8; ++k) {
        if (p.has(p.grid.ix(cell) + around_dx[k], p.grid.iy(cell) + around_dy[k])) bits |= 1U << k;
    }
    return bits;
}

// The skeleton of a whole domain, where nothing is unknown.
inline Picture skeleton_of(const Picture& domain) {
    Picture out = domain;
    const std::vector<Cell> state = thin(domain.grid, domain.set, distance_of(domain));
    for (std::size_t i = 0; i < state.size(); ++i) {
        out.set[i] = static_cast<std::uint8_t>(state[i]);  // 2 would be no bit of a picture
    }
    return out;
}

// The set cells as a list and back.
inline SkeletonCells cells_of(const Picture& p, const DistanceField& distance) {
    SkeletonCells out;
    for (std::int64_t c = 0; c < p.grid.size(); ++c) {
        if (p.set[static_cast<std::size_t>(c)] == 0) continue;
        out.cell.push_back(c);
        out.squared.push_back(distance.squared[static_cast<std::size_t>(c)]);
    }
    return out;
}
inline Picture picture_of(const Grid& grid, const SkeletonCells& cells) {
    Picture p = blank(grid.nx, grid.ny);
    for (const std::int64_t c : cells.cell) p.set[static_cast<std::size_t>(c)] = 1;
    return p;
}

// Rooms, corridors and specks: a random domain with components and holes of many sizes.
inline Picture random_domain(std::mt19937_64& random, std::int32_t nx, std::int32_t ny) {
    Picture p = blank(nx, ny);
    const auto below = [&](std::int32_t n) {
        return static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(n));
    };
    for (int k = 0; k < 14; ++k) {
        const std::int32_t x0 = below(nx);
        const std::int32_t y0 = below(ny);
        const std::int32_t x1 = std::min(nx, x0 + 1 + below(nx / 2));
        const std::int32_t y1 = std::min(ny, y0 + 1 + below(ny / 2));
        const std::uint8_t value = k % 3 == 2 ? 0 : 1;
        for (std::int32_t y = y0; y < y1; ++y) {
            for (std::int32_t x = x0; x < x1; ++x) p.at(x, y) = value;
        }
    }
    for (int k = 0; k < nx * ny / 60; ++k) p.at(below(nx), below(ny)) ^= 1;
    return p;
}

// Connected groups of cells equal to `value`, on the picture with a frame of unset cells.
inline int groups(const Picture& p, bool value, bool diagonals) {
    const std::int32_t nx = p.grid.nx + 2;
    const std::int32_t ny = p.grid.ny + 2;
    std::vector<std::uint8_t> open(static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny));
    const auto index = [&](std::int32_t x, std::int32_t y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) +
               static_cast<std::size_t>(x);
    };
    for (std::int32_t y = 0; y < ny; ++y) {
        for (std::int32_t x = 0; x < nx; ++x) open[index(x, y)] = p.has(x - 1, y - 1) == value;
    }
    int count = 0;
    for (std::int32_t y = 0; y < ny; ++y) {
        for (std::int32_t x = 0; x < nx; ++x) {
            if (open[index(x, y)] == 0) continue;
            ++count;
            std::vector<std::pair<std::int32_t, std::int32_t>> stack = {{x, y}};
            open[index(x, y)] = 0;
            while (!stack.empty()) {
                const auto [cx, cy] = stack.back();
                stack.pop_back();
                for (std::int32_t dy = -1; dy <= 1; ++dy) {
                    for (std::int32_t dx = -1; dx <= 1; ++dx) {
                        if (!diagonals && dx != 0 && dy != 0) continue;
                        const std::int32_t tx = cx + dx;
                        const std::int32_t ty = cy + dy;
                        if (tx < 0 || ty < 0 || tx >= nx || ty >= ny) continue;
                        if (open[index(tx, ty)] == 0) continue;
                        open[index(tx, ty)] = 0;
                        stack.emplace_back(tx, ty);
                    }
                }
            }
        }
    }
    return count;
}

inline int parts(const Picture& p) { return groups(p, true, true); }
inline int holes(const Picture& p) { return groups(p, false, false) - 1; }

}  // namespace vfplan::test
