#include "kernels/ridges.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "kernels/index.h"
#include "kernels/skeleton.h"

namespace vfplan {
namespace {

// Calls f(neighbour cell) for the skeleton neighbours of a cell.
template <class F>
void each_neighbour(const Grid& grid, const Raster<std::uint8_t>& skeleton, std::int64_t cell,
                    F&& f) {
    const unsigned bits = neighbourhood(grid, skeleton, cell);
    for (std::size_t k = 0; k < 8; ++k) {
        if ((bits >> k & 1U) == 0) continue;
        f(grid.id(grid.ix(cell) + around_dx[k], grid.iy(cell) + around_dy[k]));
    }
}

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

RidgeGraph ridge_graph(const Grid& grid, const Raster<std::uint8_t>& skeleton) {
    constexpr std::int32_t no_skeleton = -3;
    constexpr std::int32_t line = -2;
    constexpr std::int32_t line_done = -4;
    constexpr std::int32_t joint_open = -1;
    RidgeGraph out;
    Raster<std::int32_t> label(skeleton.size(), no_skeleton);
    std::vector<std::int64_t> cells;
    for (std::int64_t c = 0; c < grid.size(); ++c) {
        if (skeleton[at(c)] == 0) continue;
        cells.push_back(c);
        const bool branches = std::popcount(neighbourhood(grid, skeleton, c)) >= 3;
        label[at(c)] = branches ? joint_open : line;
    }

    for (const std::int64_t seed : cells) {
        if (label[at(seed)] != joint_open) continue;
        const auto id = static_cast<std::int32_t>(out.joints.size());
        std::vector<std::int64_t> cluster = {seed};
        label[at(seed)] = id;
        for (std::size_t i = 0; i < cluster.size(); ++i) {
            each_neighbour(grid, skeleton, cluster[i], [&](std::int64_t n) {
                if (label[at(n)] != joint_open) return;
                label[at(n)] = id;
                cluster.push_back(n);
            });
        }
        out.joints.push_back(nearest_to_centroid(grid, cluster));
    }

    // Walks along line cells from `from`, appending, until a joint or an end; tells the joint.
    const auto follow = [&](std::int64_t from, Ridge& ridge) {
        std::int64_t cell = from;
        while (true) {
            label[at(cell)] = line_done;
            ridge.cells.push_back(cell);
            std::int64_t next = -1;
            each_neighbour(grid, skeleton, cell, [&](std::int64_t n) {
                if (next < 0 && label[at(n)] == line) next = n;
            });
            if (next < 0) return;
            cell = next;
        }
    };
    const auto joints_at = [&](std::int64_t cell) {
        std::vector<std::int32_t> found;
        each_neighbour(grid, skeleton, cell, [&](std::int64_t n) {
            if (label[at(n)] >= 0) found.push_back(label[at(n)]);
        });
        return found;
    };
    const auto line_neighbours = [&](std::int64_t cell) {
        int count = 0;
        each_neighbour(grid, skeleton, cell, [&](std::int64_t n) {
            if (label[at(n)] == line || label[at(n)] == line_done) ++count;
        });
        return count;
    };
    for (const bool rings : {false, true}) {
        for (const std::int64_t seed : cells) {
            if (label[at(seed)] != line) continue;
            if (!rings && line_neighbours(seed) > 1) continue;
            Ridge ridge;
            follow(seed, ridge);
            ridge.ring = rings;
            if (!rings) {
                const auto front = joints_at(ridge.cells.front());
                const auto back = joints_at(ridge.cells.back());
                if (ridge.cells.size() == 1) {
                    if (!front.empty()) ridge.joint[0] = front[0];
                    if (front.size() > 1) ridge.joint[1] = front[1];
                } else {
                    if (!front.empty()) ridge.joint[0] = front[0];
                    if (!back.empty()) ridge.joint[1] = back[0];
                }
            }
            out.ridges.push_back(std::move(ridge));
        }
    }
    return out;
}

std::int64_t prune_spurs(const Grid& grid, const DistanceField& distance,
                         Raster<std::uint8_t>& skeleton) {
    std::int64_t pruned = 0;
    while (true) {
        const RidgeGraph graph = ridge_graph(grid, skeleton);
        std::int64_t now = 0;
        for (const Ridge& ridge : graph.ridges) {
            const bool spur = (ridge.joint[0] < 0) != (ridge.joint[1] < 0);
            if (!spur) continue;
            const std::int32_t joint = std::max(ridge.joint[0], ridge.joint[1]);
            const std::int64_t joint_cell = graph.joints[at(joint)];
            const double clearance =
                std::sqrt(static_cast<double>(distance.squared[at(joint_cell)]));
            const double length = arc_cells(grid, ridge.cells, 0, ridge.cells.size() - 1) + 1;
            if (length >= clearance) continue;
            for (const std::int64_t c : ridge.cells) skeleton[at(c)] = 0;
            ++now;
        }
        if (now == 0) return pruned;
        pruned += now;
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
