// Shortest ways over cells.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <queue>
#include <vector>

#include "kernels/free_cells.h"
#include "kernels/grid.h"

namespace vfplan {

// A flood from many sources over free cells that no wall parts, nearest first: distance in steps of
// 10 and 14, so that it is a whole number, and the neighbour that it came from. Ties fall the same
// way on every machine.
class Flood {
public:
    // `closed`: see closed_links().
    Flood(const Grid& grid, const Raster<std::uint8_t>& free, const Raster<std::uint8_t>& closed)
        : grid_(grid),
          free_(free),
          closed_(closed),
          distance_(free.size(), unreached),
          from_(free.size(), -1),
          source_(free.size(), -1) {}

    static constexpr std::int32_t unreached = std::numeric_limits<std::int32_t>::max();

    void add_source(std::int64_t cell, std::int32_t name) {
        if (distance_[index(cell)] == 0) return;
        distance_[index(cell)] = 0;
        source_[index(cell)] = name;
        queue_.emplace(0, cell);
    }

    void run() {
        while (!queue_.empty()) {
            const auto [d, cell] = queue_.top();
            queue_.pop();
            if (d != distance_[index(cell)]) continue;
            for (std::size_t k = 0; k < 8; ++k) {
                const std::int32_t x = grid_.ix(cell) + around_dx[k];
                const std::int32_t y = grid_.iy(cell) + around_dy[k];
                if ((closed_[index(cell)] >> k & 1U) != 0 || !grid_.inside(x, y)) continue;
                const std::int64_t n = grid_.id(x, y);
                if (free_[index(n)] == 0) continue;
                const std::int32_t far = d + (k % 2 == 0 ? 10 : 14);
                if (far >= distance_[index(n)]) continue;
                distance_[index(n)] = far;
                from_[index(n)] = cell;
                source_[index(n)] = source_[index(cell)];
                queue_.emplace(far, n);
            }
        }
    }

    std::int32_t distance(std::int64_t cell) const { return distance_[index(cell)]; }
    std::int32_t source(std::int64_t cell) const { return source_[index(cell)]; }
    // From the source to the cell.
    std::vector<std::int64_t> path_to(std::int64_t cell) const {
        std::vector<std::int64_t> path;
        for (std::int64_t c = cell; c >= 0; c = from_[index(c)]) path.push_back(c);
        std::reverse(path.begin(), path.end());
        return path;
    }

private:
    static std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }
    using Entry = std::pair<std::int32_t, std::int64_t>;
    const Grid& grid_;
    const Raster<std::uint8_t>& free_;
    const Raster<std::uint8_t>& closed_;
    std::vector<std::int32_t> distance_;
    std::vector<std::int64_t> from_;
    std::vector<std::int32_t> source_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

}  // namespace vfplan
