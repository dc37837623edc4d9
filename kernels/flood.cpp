#include "kernels/flood.h"

#include <algorithm>

namespace vfplan {

Flood::Flood(const Grid& grid, const Raster<std::uint8_t>& free, const Raster<std::uint8_t>& closed,
             std::int32_t most)
    : grid_(grid),
      free_(free),
      closed_(closed),
      most_(most),
      distance_(free.size(), unreached),
      source_(free.size(), -1),
      over_(free.size(), -1),
      waiting_(buckets) {}

void Flood::add_source(std::int64_t cell, std::int32_t name) {
    if (distance_[idx(cell)] == 0 && source_[idx(cell)] <= name) return;
    if (distance_[idx(cell)] != 0) {
        waiting_[0].push_back(cell);
        ++left_;
    }
    distance_[idx(cell)] = 0;
    source_[idx(cell)] = name;
}

void Flood::reach(std::int64_t cell, std::int32_t far, std::int32_t source, std::int8_t over) {
    const std::size_t i = idx(cell);
    if (far > distance_[i] || far > most_) return;
    if (far == distance_[i]) {
        if (source > source_[i] || (source == source_[i] && over >= over_[i])) return;
    } else {
        waiting_[static_cast<std::size_t>(far) % buckets].push_back(cell);
        ++left_;
    }
    distance_[i] = far;
    source_[i] = source;
    over_[i] = over;
}

void Flood::run() {
    std::vector<std::int64_t> now;
    for (std::int32_t d = 0; left_ > 0; ++d) {
        now.clear();
        now.swap(waiting_[static_cast<std::size_t>(d) % buckets]);
        left_ -= now.size();
        for (const std::int64_t cell : now) {
            if (distance_[idx(cell)] != d) continue;  // came nearer since
            for (std::size_t k = 0; k < 8; ++k) {
                const std::int32_t x = grid_.ix(cell) + around_dx[k];
                const std::int32_t y = grid_.iy(cell) + around_dy[k];
                if ((closed_[idx(cell)] >> k & 1U) != 0 || !grid_.inside(x, y)) continue;
                const std::int64_t n = grid_.id(x, y);
                if (free_[idx(n)] == 0 || distance_[idx(n)] == 0) continue;
                reach(n, d + (k % 2 == 0 ? 10 : 14), source_[idx(cell)],
                      static_cast<std::int8_t>((k + 4) % 8));
            }
        }
    }
}

std::vector<std::int64_t> Flood::path_to(std::int64_t cell) const {
    std::vector<std::int64_t> path;
    for (std::int64_t c = cell;;) {
        path.push_back(c);
        const std::int8_t over = over_[idx(c)];
        if (over < 0) break;
        const auto k = static_cast<std::size_t>(over);
        c = grid_.id(grid_.ix(c) + around_dx[k], grid_.iy(c) + around_dy[k]);
    }
    std::reverse(path.begin(), path.end());
    return path;
}

}  // namespace vfplan
