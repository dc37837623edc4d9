#include "kernels/ridges.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Skeleton cells by their index, with their neighbours.
class Lines {
public:
    Lines(const Grid& grid, const SkeletonCells& skeleton)
        : grid_(grid), cell_(skeleton.cell), below_(cell_.size()), above_(cell_.size()) {
        // The first skeleton cell at or behind the south-west and north-west neighbour.
        std::size_t low = 0;
        std::size_t high = 0;
        for (std::size_t i = 0; i < cell_.size(); ++i) {
            while (low < cell_.size() && cell_[low] < cell_[i] - grid.nx - 1) ++low;
            while (high < cell_.size() && cell_[high] < cell_[i] + grid.nx - 1) ++high;
            below_[i] = static_cast<std::int32_t>(low);
            above_[i] = static_cast<std::int32_t>(high);
        }
    }

    std::size_t size() const { return cell_.size(); }
    std::int64_t cell(std::size_t i) const { return cell_[i]; }

    // Calls f(neighbour's index), counter-clockwise from east.
    template <class F>
    void each_neighbour(std::size_t i, F&& f) const {
        std::array<std::int64_t, 8> found;
        found.fill(-1);
        const std::int32_t x = grid_.ix(cell_[i]);
        const auto look = [&](std::size_t from, std::int64_t row_step) {
            for (std::size_t j = from; j < cell_.size(); ++j) {
                const std::int64_t off = cell_[j] - cell_[i] - row_step;
                if (off > 1) break;
                const bool wraps = (off < 0 && x == 0) || (off > 0 && x + 1 == grid_.nx);
                if (off < -1 || wraps || j == i) continue;
                for (std::size_t k = 0; k < 8; ++k) {
                    if (around_dx[k] == off && around_dy[k] * std::int64_t{grid_.nx} == row_step) {
                        found[k] = static_cast<std::int64_t>(j);
                    }
                }
            }
        };
        look(idx(below_[i]), -grid_.nx);
        look(i > 0 ? i - 1 : 0, 0);
        look(idx(above_[i]), grid_.nx);
        for (const std::int64_t j : found) {
            if (j >= 0) f(idx(j));
        }
    }

    int neighbours(std::size_t i) const {
        int n = 0;
        each_neighbour(i, [&](std::size_t) { ++n; });
        return n;
    }

private:
    const Grid& grid_;
    const std::vector<std::int64_t>& cell_;
    std::vector<std::int32_t> below_;
    std::vector<std::int32_t> above_;
};

std::int64_t nearest_to_centroid(const Grid& grid, const std::vector<std::int64_t>& cells) {
    double sx = 0;
    double sy = 0;
    for (const std::int64_t c : cells) {
        sx += grid.ix(c);
        sy += grid.iy(c);
    }
    const auto n = static_cast<double>(cells.size());
    std::int64_t best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const std::int64_t c : cells) {
        const double dx = n * grid.ix(c) - sx;  // integers: ties are exact
        const double dy = n * grid.iy(c) - sy;
        const double d = dx * dx + dy * dy;
        if (d < least || (d == least && c < best)) {
            least = d;
            best = c;
        }
    }
    return best;
}

}  // namespace

RidgeGraph ridge_graph(const Grid& grid, const SkeletonCells& skeleton) {
    constexpr std::int32_t line = -2;
    constexpr std::int32_t line_done = -4;
    constexpr std::int32_t joint_open = -1;
    RidgeGraph out;
    const Lines lines(grid, skeleton);
    std::vector<std::int32_t> label(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        label[i] = lines.neighbours(i) >= 3 ? joint_open : line;
    }

    for (std::size_t seed = 0; seed < lines.size(); ++seed) {
        if (label[seed] != joint_open) continue;
        const auto id = static_cast<std::int32_t>(out.joints.size());
        std::vector<std::size_t> cluster = {seed};
        std::vector<std::int64_t> cells = {lines.cell(seed)};
        label[seed] = id;
        for (std::size_t i = 0; i < cluster.size(); ++i) {
            lines.each_neighbour(cluster[i], [&](std::size_t n) {
                if (label[n] != joint_open) return;
                label[n] = id;
                cluster.push_back(n);
                cells.push_back(lines.cell(n));
            });
        }
        out.joints.push_back(nearest_to_centroid(grid, cells));
    }

    // Walks along line cells from `from`, appending, until a joint or an end; tells the last one.
    constexpr std::size_t none = static_cast<std::size_t>(-1);
    const auto follow = [&](std::size_t from, Ridge& ridge) {
        std::size_t last = from;
        for (std::size_t i = from; i != none;) {
            label[i] = line_done;
            ridge.cells.push_back(lines.cell(i));
            last = i;
            std::size_t next = none;
            lines.each_neighbour(i, [&](std::size_t n) {
                if (next == none && label[n] == line) next = n;
            });
            i = next;
        }
        return last;
    };
    const auto joints_at = [&](std::size_t i) {
        std::vector<std::int32_t> found;
        lines.each_neighbour(i, [&](std::size_t n) {
            if (label[n] >= 0) found.push_back(label[n]);
        });
        return found;
    };
    const auto line_neighbours = [&](std::size_t i) {
        int count = 0;
        lines.each_neighbour(i, [&](std::size_t n) {
            if (label[n] == line || label[n] == line_done) ++count;
        });
        return count;
    };
    for (const bool rings : {false, true}) {
        for (std::size_t seed = 0; seed < lines.size(); ++seed) {
            if (label[seed] != line) continue;
            if (!rings && line_neighbours(seed) > 1) continue;
            Ridge ridge;
            const std::size_t last = follow(seed, ridge);
            ridge.ring = rings;
            if (!rings) {
                const auto front = joints_at(seed);
                const auto back = joints_at(last);
                if (!front.empty()) ridge.joint[0] = front[0];
                if (ridge.cells.size() == 1) {
                    if (front.size() > 1) ridge.joint[1] = front[1];
                } else if (!back.empty()) {
                    ridge.joint[1] = back[0];
                }
            }
            ridge.cells.shrink_to_fit();
            out.ridges.push_back(std::move(ridge));
        }
    }
    return out;
}

std::int64_t prune_spurs(const Grid& grid, SkeletonCells& skeleton) {
    const auto index_of = [&](std::int64_t cell) {
        const auto found = std::lower_bound(skeleton.cell.begin(), skeleton.cell.end(), cell);
        return idx(found - skeleton.cell.begin());
    };
    std::int64_t pruned = 0;
    while (true) {
        const RidgeGraph graph = ridge_graph(grid, skeleton);
        std::vector<std::uint8_t> gone(skeleton.cell.size(), 0);
        std::int64_t now = 0;
        for (const Ridge& ridge : graph.ridges) {
            const bool spur = (ridge.joint[0] < 0) != (ridge.joint[1] < 0);
            if (!spur) continue;
            const std::int32_t joint = std::max(ridge.joint[0], ridge.joint[1]);
            const double clearance = std::sqrt(
                static_cast<double>(skeleton.squared[index_of(graph.joints[idx(joint)])]));
            const double length = arc_cells(grid, ridge.cells, 0, ridge.cells.size() - 1) + 1;
            if (length >= clearance) continue;
            for (const std::int64_t c : ridge.cells) gone[index_of(c)] = 1;
            ++now;
        }
        if (now == 0) return pruned;
        pruned += now;
        std::size_t left = 0;
        for (std::size_t i = 0; i < gone.size(); ++i) {
            if (gone[i] != 0) continue;
            skeleton.cell[left] = skeleton.cell[i];
            skeleton.squared[left] = skeleton.squared[i];
            ++left;
        }
        skeleton.cell.resize(left);
        skeleton.squared.resize(left);
    }
}

double arc_cells(const Grid& grid, const std::vector<std::int64_t>& cells, std::size_t from,
                 std::size_t to) {
    std::int64_t straight = 0;  // counted, not summed: the same from either end
    std::int64_t diagonal = 0;
    for (std::size_t i = from; i < to; ++i) {
        const bool dx = grid.ix(cells[i]) != grid.ix(cells[i + 1]);
        const bool dy = grid.iy(cells[i]) != grid.iy(cells[i + 1]);
        (dx && dy ? diagonal : straight) += 1;
    }
    return static_cast<double>(straight) + std::sqrt(2.0) * static_cast<double>(diagonal);
}

std::size_t arc_middle(const Grid& grid, const std::vector<std::int64_t>& cells, std::size_t from,
                       std::size_t to) {
    assert(to >= from + 2);
    const double half = arc_cells(grid, cells, from, to) / 2;
    std::size_t best = from + 1;
    double best_off = std::numeric_limits<double>::infinity();
    double along = 0;
    for (std::size_t i = from + 1; i < to; ++i) {
        along += arc_cells(grid, cells, i - 1, i);
        const double off = std::abs(along - half);
        if (off < best_off) {
            best_off = off;
            best = i;
        }
    }
    return best;
}

}  // namespace vfplan
