#include "kernels/passages.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

class Passages {
public:
    Passages(const Grid& grid, const Raster<std::uint8_t>& free, const Raster<std::uint8_t>& near,
             const std::vector<Wall>& walls, double clearance_m)
        : grid_(grid), free_(free), near_(near), walls_(walls), clearance_m_(clearance_m) {}

    Raster<std::uint8_t> cells() {
        nearest_.assign(free_.size(), nobody);
        opposite_.assign(free_.size(), nobody);
        for (std::size_t w = 0; w < walls_.size(); ++w) {
            each_in_reach(walls_[w], clearance_m_, [&](std::int64_t cell, const Vec2d& way) {
                std::int32_t& best = nearest_[idx(cell)];
                if (best != nobody &&
                    way.squaredNorm() >=
                        way_to(walls_[idx(best)], grid_.centre(cell)).squaredNorm())
                    return;
                best = static_cast<std::int32_t>(w);
            });
        }
        for (std::size_t w = 0; w < walls_.size(); ++w) {
            each_in_reach(walls_[w], clearance_m_ + grid_.cell_m,
                          [&](std::int64_t cell, const Vec2d& way) {
                              look_across(static_cast<std::int32_t>(w), cell, way);
                          });
        }
        Raster<std::uint8_t> out(free_.size(), 0);
        for (std::size_t c = 0; c < out.size(); ++c) {
            if (opposite_[c] == nobody) continue;
            out[c] = joins_two(static_cast<std::int64_t>(c)) ? 1 : 0;
        }
        return out;
    }

private:
    static constexpr std::int32_t nobody = -1;
    // A cosine: walls that stand in one corner are not opposite to each other.
    static constexpr double opposite_most = 0.5;

    // Calls f(cell, way to the wall) for those that are free and near to walls, this one so far.
    template <class F>
    void each_in_reach(const Wall& wall, double reach_m, F f) const {
        each_cell_near(
            grid_, wall, reach_m,
            [&](std::int64_t cell) { return free_[idx(cell)] != 0 && near_[idx(cell)] != 0; }, f);
    }

    // Keeps the wall that stands most opposite to the cell's nearest one.
    void look_across(std::int32_t wall, std::int64_t cell, const Vec2d& way) {
        const Vec2d at = grid_.centre(cell);
        const Vec2d to_nearest = way_to(walls_[idx(nearest_[idx(cell)])], at);
        const double near_m = to_nearest.norm();
        if (way.norm() > near_m + grid_.cell_m || (way - to_nearest).norm() < clearance_m_) return;
        const double cosine = way.dot(to_nearest) / (way.norm() * near_m);
        if (cosine > opposite_most) return;
        std::int32_t& best = opposite_[idx(cell)];
        if (best != nobody) {
            const Vec2d other = way_to(walls_[idx(best)], at);
            if (cosine >= other.dot(to_nearest) / (other.norm() * near_m)) return;
        }
        best = wall;
    }

    bool joins_two(std::int64_t cell) const {
        const Vec2d at = grid_.centre(cell);
        const Vec2d a = way_to(walls_[idx(nearest_[idx(cell)])], at);
        const Vec2d b = way_to(walls_[idx(opposite_[idx(cell)])], at);
        const Vec2d across = (b - a).normalized();
        const Vec2d along(-across.y(), across.x());
        std::vector<std::int32_t> around;
        const double reach_m = passage_reach_m(clearance_m_);
        for (std::size_t w = 0; w < walls_.size(); ++w) {
            const Wall& wall = walls_[w];
            if (std::max(wall.a.x(), wall.b.x()) < at.x() - reach_m) continue;
            if (std::min(wall.a.x(), wall.b.x()) > at.x() + reach_m) continue;
            if (std::max(wall.a.y(), wall.b.y()) < at.y() - reach_m) continue;
            if (std::min(wall.a.y(), wall.b.y()) > at.y() + reach_m) continue;
            around.push_back(static_cast<std::int32_t>(w));
        }
        return leads_on(at, along, across, around) && leads_on(at, -along, across, around);
    }

    // True where a cell with the clearance is seen that way.
    bool leads_on(const Vec2d& at, const Vec2d& along, const Vec2d& across,
                  const std::vector<std::int32_t>& around) const {
        // cos and sin of 0, 30 and 60 degrees to either side
        constexpr double root = 0.8660254037844386;
        constexpr std::array<std::array<double, 2>, 5> ways = {
            {{1, 0}, {root, 0.5}, {root, -0.5}, {0.5, root}, {0.5, -root}}};
        for (const auto& [ahead, aside] : ways) {
            const Vec2d step = grid_.cell_m * (ahead * along + aside * across);
            const auto steps = static_cast<int>(passage_reach_m(clearance_m_) / grid_.cell_m);
            for (int i = 1; i <= steps; ++i) {
                const Vec2d p = (at + i * step - grid_.origin) / grid_.cell_m;
                if (p.x() < 0 || p.y() < 0) break;
                if (p.x() >= grid_.nx || p.y() >= grid_.ny) break;
                const std::int64_t cell =
                    grid_.id(static_cast<std::int32_t>(p.x()), static_cast<std::int32_t>(p.y()));
                if (free_[idx(cell)] == 0 || near_[idx(cell)] != 0) continue;
                const Vec2d there = grid_.centre(cell);
                const bool seen = std::none_of(around.begin(), around.end(), [&](std::int32_t w) {
                    return segments_meet(walls_[idx(w)].a, walls_[idx(w)].b, at, there);
                });
                if (seen) return true;
                break;
            }
        }
        return false;
    }

    const Grid& grid_;
    const Raster<std::uint8_t>& free_;
    const Raster<std::uint8_t>& near_;
    const std::vector<Wall>& walls_;
    double clearance_m_;
    Raster<std::int32_t> nearest_;   // wall of a cell
    Raster<std::int32_t> opposite_;  // likewise, where the cell is in the middle
};

}  // namespace

Raster<std::uint8_t> cells_in_passages(const Grid& grid, const Raster<std::uint8_t>& free,
                                       const Raster<std::uint8_t>& near,
                                       const std::vector<Wall>& walls, double clearance_m) {
    return Passages(grid, free, near, walls, clearance_m).cells();
}

}  // namespace vfplan
