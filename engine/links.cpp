#include <algorithm>
#include <map>

#include "engine/candidates.h"
#include "engine/flood.h"
#include "engine/graph.h"
#include "kernels/free_cells.h"

namespace vfplan {
namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

std::vector<std::int32_t> parts_of(const CandidatePool& pool, const CandidateOptions& options) {
    CoverageTable table;
    for (const CoverageRow& row : pool.rows()) table.add(row);
    return components(overlap_graph(pool.threads(), pool.viewer().pieces(), table, options.ratio,
                                    options.threshold));
}

std::int64_t count_parts(const std::vector<std::int32_t>& part) {
    return part.empty() ? 0 : 1 + *std::max_element(part.begin(), part.end());
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
    for (int round = 0; round < rounds_most && count_parts(part) > 1; ++round) {
        Flood flood(ground.grid, ground.standable, ground.closed);
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
        if (paths.empty()) break;
        const std::vector<Stuck> stuck = split_paths(pool, paths, options, CandidateKind::link);
        split_between_cells(pool, stuck, options);
        part = parts_of(pool, options);
    }
    report.parts = count_parts(part);
}

}  // namespace vfplan
