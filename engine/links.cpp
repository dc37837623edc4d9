#include <algorithm>
#include <map>

#include "engine/candidates.h"
#include "engine/flood.h"
#include "engine/graph.h"
#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

std::vector<std::int32_t> parts_of(const CandidatePool& pool, const CandidateOptions& options) {
    CoverageTable table;
    for (const CoverageRow& row : pool.rows()) table.add(row);
    return components(overlap_graph(pool.threads(), pool.viewer().pieces(), table, options.ratio,
                                    options.threshold));
}

std::int64_t count_parts(const std::vector<std::int32_t>& part) {
    return part.empty() ? 0 : 1 + *std::max_element(part.begin(), part.end());
}

// A point of a way, looked from.
struct Stand {
    Vec2d at;
    std::size_t step;  // on the way, or no_step between two steps
    CoverageRow row;
    float vf_rad = 0;
};
constexpr std::size_t no_step = static_cast<std::size_t>(-1);

// Tries to bridge one way; the stands in between, or nothing when some neighbours stay apart.
class Bridge {
public:
    Bridge(const CandidatePool& pool, const CandidateOptions& options, const CellPath& way)
        : pool_(pool), options_(options), way_(way) {}

    bool build(std::vector<Stand>& out) {
        const Stand first{centre(0), 0, pool_.row_at(way_.front())};
        const Stand last{centre(way_.size() - 1), way_.size() - 1, pool_.row_at(way_.back())};
        const bool good = between(first, last);
        if (good) out = std::move(stands_);
        return good;
    }

private:
    Vec2d centre(std::size_t step) const { return pool_.ground().grid.centre(way_[step]); }

    // Depth first and from the near end, so that a way that cannot be bridged is soon given up.
    bool between(const Stand& a, const Stand& b) {
        if (overlap(options_.ratio, pool_.viewer().pieces(), a.row, b.row) >= options_.threshold) {
            return true;
        }
        Stand middle;
        if (a.step != no_step && b.step != no_step && b.step >= a.step + 2) {
            middle.step = arc_middle(pool_.ground().grid, way_, a.step, b.step);
            middle.at = centre(middle.step);
        } else {
            if ((b.at - a.at).norm() / 2 < least_step_m) return false;
            middle.step = no_step;
            middle.at = (a.at + b.at) / 2;
        }
        Viewer::Look look = pool_.viewer().look(middle.at);
        middle.vf_rad = static_cast<float>(look.vf_rad);
        middle.row = std::move(look.row);
        if (middle.row.empty()) return false;
        if (!between(a, middle) || !between(middle, b)) return false;
        stands_.push_back(std::move(middle));
        return true;
    }

    const CandidatePool& pool_;
    const CandidateOptions& options_;
    const CellPath& way_;
    std::vector<Stand> stands_;
};

// Cells that a way may lead over: those that see anything.
Raster<std::uint8_t> seeing_cells(const Ground& ground) {
    Raster<std::uint8_t> out = ground.standable;
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!(ground.field[i] > 0)) out[i] = 0;
    }
    return out;
}

// Where floods from two parts meet with the shortest way between them.
struct Meeting {
    std::int32_t length = Flood::unreached;
    std::int64_t a = -1;
    std::int64_t b = -1;
};

}  // namespace

void link_parts(CandidatePool& pool, const CandidateOptions& options, CandidateReport& report) {
    constexpr int rounds_most = 6;
    const Ground& ground = pool.ground();
    std::vector<std::int32_t> part = parts_of(pool, options);
    report.parts_before_links = count_parts(part);
    std::map<std::pair<std::int64_t, std::int64_t>, bool> tried;
    const Raster<std::uint8_t> seeing = seeing_cells(ground);
    for (int round = 0; round < rounds_most && count_parts(part) > 1; ++round) {
        Flood flood(ground.grid, seeing, ground.closed);
        for (std::size_t i = 0; i < pool.candidates().size(); ++i) {
            const std::int64_t cell = pool.candidates()[i].cell;
            if (cell >= 0) flood.add_source(cell, part[i]);
        }
        flood.run();
        std::map<std::pair<std::int32_t, std::int32_t>, Meeting> meetings;
        const Grid& grid = ground.grid;
        for (std::int64_t cell = 0; cell < grid.size(); ++cell) {
            if (flood.distance(cell) == Flood::unreached) continue;
            for (std::size_t k = 0; k < 4; ++k) {
                const std::int32_t x = grid.ix(cell) + around_dx[k];
                const std::int32_t y = grid.iy(cell) + around_dy[k];
                if ((ground.closed[at(cell)] >> k & 1U) != 0 || !grid.inside(x, y)) continue;
                const std::int64_t n = grid.id(x, y);
                if (flood.distance(n) == Flood::unreached ||
                    flood.source(n) == flood.source(cell)) {
                    continue;
                }
                Meeting& best = meetings[std::minmax(flood.source(cell), flood.source(n))];
                const std::int32_t length =
                    flood.distance(cell) + flood.distance(n) + (k % 2 == 0 ? 10 : 14);
                if (length < best.length) best = {length, cell, n};
            }
        }
        std::vector<CellPath> paths;
        for (const auto& [names, m] : meetings) {
            CellPath path = flood.path_to(m.a);
            const CellPath rest = flood.path_to(m.b);
            path.insert(path.end(), rest.rbegin(), rest.rend());
            if (tried.emplace(std::pair(path.front(), path.back()), true).second) {
                paths.push_back(std::move(path));
            }
        }
        std::vector<std::vector<Stand>> bridges(paths.size());
        std::vector<std::uint8_t> good(paths.size(), 0);
        pool.threads().for_each(static_cast<std::int64_t>(paths.size()), 1,
                                [&](std::int64_t from, std::int64_t to) {
                                    for (std::int64_t i = from; i < to; ++i) {
                                        Bridge bridge(pool, options, paths[at(i)]);
                                        good[at(i)] = bridge.build(bridges[at(i)]) ? 1 : 0;
                                    }
                                });
        if (std::find(good.begin(), good.end(), 1) == good.end()) break;
        for (std::size_t i = 0; i < paths.size(); ++i) {
            for (Stand& s : bridges[i]) {
                pool.add_seen(s.at, s.step == no_step ? -1 : paths[i][s.step], CandidateKind::link,
                              std::move(s.row), s.vf_rad);
            }
        }
        part = parts_of(pool, options);
    }
    report.parts = count_parts(part);
}

}  // namespace vfplan
