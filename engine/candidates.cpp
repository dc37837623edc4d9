#include "engine/candidates.h"
#include "kernels/index.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace vfplan {
namespace {

// The points that a ridge without joints stands for: the middle of a line, two opposite points
// of a ring.
std::vector<std::int64_t> points_without_joint(const Grid& grid, const Ridge& ridge) {
    const auto& cells = ridge.cells;
    if (ridge.ring && cells.size() > 2) {
        CellPath closed = cells;
        closed.push_back(cells.front());
        return {cells.front(), closed[arc_middle(grid, closed, 0, closed.size() - 1)]};
    }
    if (cells.size() < 3) return {cells.front()};
    return {cells[arc_middle(grid, cells, 0, cells.size() - 1)]};
}

// The ridge as a path from candidate to candidate: through its joints and the candidates on it.
std::vector<CellPath> paths_of(const CandidatePool& pool, const RidgeGraph& graph,
                               const Ridge& ridge) {
    CellPath whole;
    if (ridge.joint[0] >= 0) whole.push_back(graph.joints[at(ridge.joint[0])]);
    whole.insert(whole.end(), ridge.cells.begin(), ridge.cells.end());
    if (ridge.joint[1] >= 0) whole.push_back(graph.joints[at(ridge.joint[1])]);
    if (ridge.ring) whole.push_back(ridge.cells.front());
    std::vector<CellPath> out;
    std::size_t last = whole.size();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (!pool.has(whole[i])) continue;
        if (last < i) {
            out.emplace_back(whole.begin() + static_cast<std::ptrdiff_t>(last),
                             whole.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        }
        last = i;
    }
    return out;
}

// Ridge ends that cover a piece which no candidate so far covers.
std::vector<std::int64_t> useful_ends(CandidatePool& pool, const RidgeGraph& graph) {
    std::vector<std::int64_t> ends;
    for (const Ridge& ridge : graph.ridges) {
        if (ridge.ring) continue;
        if (ridge.joint[0] < 0) ends.push_back(ridge.cells.front());
        if (ridge.joint[1] < 0) ends.push_back(ridge.cells.back());
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<Vec2d> eyes;
    for (const std::int64_t c : ends) eyes.push_back(pool.ground().grid.centre(c));
    const std::vector<CoverageRow> rows = pool.viewer().rows(pool.threads(), eyes);
    const std::vector<std::uint8_t> covered = pool.covered();
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (std::any_of(rows[i].begin(), rows[i].end(),
                        [&](const Seen& s) { return covered[at(s.piece)] == 0; })) {
            out.push_back(ends[i]);
        }
    }
    return out;
}

CandidateResult sorted_result(const CandidatePool& pool) {
    CandidateResult out;
    std::vector<std::size_t> order(pool.candidates().size());
    std::iota(order.begin(), order.end(), 0U);
    const auto& c = pool.candidates();
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const auto key = [&](const Candidate& k) {
            const bool of_user =
                k.kind == CandidateKind::required || k.kind == CandidateKind::existing;
            return std::tuple(of_user, of_user ? 0.0 : k.at.y(), of_user ? 0.0 : k.at.x());
        };
        return key(c[a]) < key(c[b]);
    });
    for (const std::size_t i : order) {
        out.candidates.push_back(c[i]);
        out.table.add(pool.rows()[i]);
    }
    return out;
}

}  // namespace

void CandidatePool::add(const std::vector<std::int64_t>& cells, CandidateKind kind) {
    std::vector<std::int64_t> fresh = cells;
    std::sort(fresh.begin(), fresh.end());
    fresh.erase(std::unique(fresh.begin(), fresh.end()), fresh.end());
    std::erase_if(fresh, [&](std::int64_t c) { return has(c); });
    std::vector<Vec2d> eyes;
    for (const std::int64_t c : fresh) eyes.push_back(ground_.grid.centre(c));
    std::vector<CoverageRow> rows = viewer_.rows(threads_, eyes);
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        index_.emplace(fresh[i], candidates_.size());
        candidates_.push_back({eyes[i], fresh[i], kind, ground_.field[at(fresh[i])]});
        rows_.push_back(std::move(rows[i]));
    }
}

void CandidatePool::add_seen(const Vec2d& point, std::int64_t cell, CandidateKind kind,
                             CoverageRow row, float vf_rad) {
    if (cell >= 0 && !index_.emplace(cell, candidates_.size()).second) return;
    candidates_.push_back({point, cell, kind, vf_rad});
    rows_.push_back(std::move(row));
}

void CandidatePool::add_points(const std::vector<Vec2d>& points, CandidateKind kind) {
    for (const Vec2d& p : points) {
        Viewer::Look look = viewer_.look(p);
        add_seen(p, -1, kind, std::move(look.row), static_cast<float>(look.vf_rad));
    }
}

std::vector<std::uint8_t> CandidatePool::covered() const {
    std::vector<std::uint8_t> out(at(viewer_.pieces().size()), 0);
    for (const CoverageRow& row : rows_) {
        for (const Seen& s : row) out[at(s.piece)] = 1;
    }
    return out;
}

std::int64_t split_paths(CandidatePool& pool, const std::vector<CellPath>& paths,
                         const CandidateOptions& options) {
    struct Part {
        std::size_t path;
        std::size_t from;
        std::size_t to;
    };
    constexpr int depth_most = 16;
    const Grid& grid = pool.ground().grid;
    std::vector<Part> open;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].size() > 1) open.push_back({i, 0, paths[i].size() - 1});
    }
    std::vector<std::uint8_t> falls_short(paths.size(), 0);
    for (int depth = 0; !open.empty(); ++depth) {
        std::vector<std::uint8_t> apart(open.size(), 0);
        pool.threads().for_each(
            static_cast<std::int64_t>(open.size()), 16, [&](std::int64_t from, std::int64_t to) {
                for (std::int64_t i = from; i < to; ++i) {
                    const Part& p = open[at(i)];
                    const double o = overlap(options.ratio, pool.viewer().pieces(),
                                             pool.row_at(paths[p.path][p.from]),
                                             pool.row_at(paths[p.path][p.to]));
                    apart[at(i)] = o < options.threshold ? 1 : 0;
                }
            });
        std::vector<Part> next;
        std::vector<std::int64_t> middles;
        for (std::size_t i = 0; i < open.size(); ++i) {
            if (apart[i] == 0) continue;
            const Part& p = open[i];
            if (p.to < p.from + 2 || depth == depth_most) {
                falls_short[p.path] = 1;
                continue;
            }
            const std::size_t middle = arc_middle(grid, paths[p.path], p.from, p.to);
            middles.push_back(paths[p.path][middle]);
            next.push_back({p.path, p.from, middle});
            next.push_back({p.path, middle, p.to});
        }
        pool.add(middles, CandidateKind::split);
        open = std::move(next);
    }
    return std::count(falls_short.begin(), falls_short.end(), 1);
}

CandidateResult find_candidates(const Viewer& viewer, const Threads& threads, const Ground& ground,
                                const RidgeGraph& graph, const CandidateOptions& options,
                                const std::function<void(const char*)>& progress) {
    CandidateReport report;
    report.joints = static_cast<std::int64_t>(graph.joints.size());
    report.ridges = static_cast<std::int64_t>(graph.ridges.size());
    CandidatePool pool(viewer, threads, ground);
    progress("joints");
    pool.add(graph.joints, CandidateKind::joint);
    std::vector<std::int64_t> middles;
    std::vector<std::int64_t> ring_points;
    for (const Ridge& ridge : graph.ridges) {
        if (ridge.joint[0] >= 0 || ridge.joint[1] >= 0) continue;
        for (const std::int64_t c : points_without_joint(ground.grid, ridge)) {
            (ridge.ring ? ring_points : middles).push_back(c);
        }
    }
    pool.add(middles, CandidateKind::middle);
    pool.add(ring_points, CandidateKind::ring);
    pool.add(useful_ends(pool, graph), CandidateKind::end);

    progress("ridges");
    std::vector<CellPath> paths;
    for (const Ridge& ridge : graph.ridges) {
        for (CellPath& path : paths_of(pool, graph, ridge)) paths.push_back(std::move(path));
    }
    report.ridges_short_of_overlap = split_paths(pool, paths, options);

    pool.add_points(options.required, CandidateKind::required);
    pool.add_points(options.existing, CandidateKind::existing);
    progress("rescue");
    const std::vector<PieceStatus> reach = rescue_pieces(pool, report);
    progress("links");
    link_parts(pool, options, report);

    CandidateResult out = sorted_result(pool);
    out.reach = reach;
    const std::vector<std::uint8_t> covered = pool.covered();  // links may see more
    for (std::size_t p = 0; p < covered.size(); ++p) {
        if (covered[p] != 0) out.reach[p] = PieceStatus::covered;
    }
    out.report = report;
    return out;
}

}  // namespace vfplan
