#include <algorithm>
#include <limits>
#include <map>
#include <queue>

#include "engine/candidates.h"
#include "engine/graph.h"
#include "kernels/skeleton.h"

namespace vfplan {
namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

// A flood from many sources over passable cells, nearest first: distance in steps of 10 and 14,
// so that it is a whole number, and the neighbour that it came from.
class Flood {
public:
    explicit Flood(const Ground& ground)
        : ground_(ground), distance_(ground.passable.size(), unreached),
          from_(ground.passable.size(), -1), source_(ground.passable.size(), -1) {}

    static constexpr std::int32_t unreached = std::numeric_limits<std::int32_t>::max();

    void add_source(std::int64_t cell, std::int32_t name) {
        if (distance_[at(cell)] == 0) return;
        distance_[at(cell)] = 0;
        source_[at(cell)] = name;
        queue_.emplace(0, cell);
    }

    // Goes on until `visit` says stop at a cell.
    template <class F>
    void run(F&& visit) {
        const Grid& grid = ground_.grid;
        while (!queue_.empty()) {
            const auto [d, cell] = queue_.top();
            queue_.pop();
            if (d != distance_[at(cell)]) continue;
            if (visit(cell)) return;
            for (std::size_t k = 0; k < 8; ++k) {
                const std::int32_t x = grid.ix(cell) + around_dx[k];
                const std::int32_t y = grid.iy(cell) + around_dy[k];
                if (!grid.inside(x, y)) continue;
                const std::int64_t n = grid.id(x, y);
                if (ground_.passable[at(n)] == 0) continue;
                const std::int32_t far = d + (k % 2 == 0 ? 10 : 14);
                if (far >= distance_[at(n)]) continue;
                distance_[at(n)] = far;
                from_[at(n)] = cell;
                source_[at(n)] = source_[at(cell)];
                queue_.emplace(far, n);
            }
        }
    }

    std::int32_t distance(std::int64_t cell) const { return distance_[at(cell)]; }
    std::int32_t source(std::int64_t cell) const { return source_[at(cell)]; }
    // From the source to the cell.
    CellPath path_to(std::int64_t cell) const {
        CellPath path;
        for (std::int64_t c = cell; c >= 0; c = from_[at(c)]) path.push_back(c);
        std::reverse(path.begin(), path.end());
        return path;
    }

private:
    using Entry = std::pair<std::int32_t, std::int64_t>;
    const Ground& ground_;
    std::vector<std::int32_t> distance_;
    std::vector<std::int64_t> from_;
    std::vector<std::int32_t> source_;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue_;
};

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

CellPath shortest_path(const Ground& ground, std::int64_t from,
                       const std::function<bool(std::int64_t)>& goal) {
    Flood flood(ground);
    flood.add_source(from, 0);
    std::int64_t found = -1;
    flood.run([&](std::int64_t cell) {
        if (!goal(cell)) return false;
        found = cell;
        return true;
    });
    return found < 0 ? CellPath{} : flood.path_to(found);
}

void link_parts(CandidatePool& pool, const CandidateOptions& options, CandidateReport& report) {
    constexpr int rounds_most = 6;
    const Ground& ground = pool.ground();
    std::vector<std::int32_t> part = parts_of(pool, options);
    report.parts_before_links = count_parts(part);
    std::map<std::pair<std::int64_t, std::int64_t>, bool> tried;
    for (int round = 0; round < rounds_most && count_parts(part) > 1; ++round) {
        Flood flood(ground);
        for (std::size_t i = 0; i < pool.candidates().size(); ++i) {
            const std::int64_t cell = pool.candidates()[i].cell;
            if (cell >= 0) flood.add_source(cell, part[i]);
        }
        flood.run([](std::int64_t) { return false; });
        std::map<std::pair<std::int32_t, std::int32_t>, Meeting> meetings;
        const Grid& grid = ground.grid;
        for (std::int64_t cell = 0; cell < grid.size(); ++cell) {
            if (flood.distance(cell) == Flood::unreached) continue;
            for (std::size_t k = 0; k < 4; ++k) {
                const std::int32_t x = grid.ix(cell) + around_dx[k];
                const std::int32_t y = grid.iy(cell) + around_dy[k];
                if (!grid.inside(x, y)) continue;
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
        split_paths(pool, paths, options, CandidateKind::link);
        part = parts_of(pool, options);
    }
    report.parts = count_parts(part);
}

}  // namespace vfplan
