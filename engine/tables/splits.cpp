#include "engine/tables/splits.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

#include "engine/tables/covered.h"
#include "engine/tables/joints.h"
#include "kernels/index.h"
#include "kernels/overlap_rows.h"
#include "kernels/ridges.h"

namespace vfplan {
namespace {

// Cells of a ridge from one candidate on it to the next.
using Arc = std::vector<std::int64_t>;

// Candidates of one tile's ridges while they are split, with their rows.
class Pool {
public:
    explicit Pool(const TableJob& job) : job_(job) {}

    // Looks from the cells that are not in it yet.
    void add(std::vector<std::int64_t> cells) {
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        std::erase_if(cells, [&](std::int64_t c) { return rows_.contains(c); });
        std::vector<OverlapRow> rows =
            job_.scenes.overlap_rows(job_.threads, centres(job_.layout().grid, cells));
        for (std::size_t i = 0; i < cells.size(); ++i) rows_.emplace(cells[i], std::move(rows[i]));
    }
    const OverlapRow& row(std::int64_t cell) const { return rows_.at(cell); }

private:
    const TableJob& job_;
    std::unordered_map<std::int64_t, OverlapRow> rows_;
};

// The ridge as arcs from candidate to candidate: through its joints and the candidates on it.
std::vector<Arc> arcs_of(const TileRidges::Line& ridge,
                         const std::unordered_set<std::int64_t>& candidates) {
    Arc whole;
    if (ridge.joint[0] >= 0) whole.push_back(ridge.joint[0]);
    whole.insert(whole.end(), ridge.cells.begin(), ridge.cells.end());
    if (ridge.joint[1] >= 0) whole.push_back(ridge.joint[1]);
    if (ridge.ring) whole.push_back(ridge.cells.front());
    std::vector<Arc> out;
    std::size_t last = whole.size();
    for (std::size_t i = 0; i < whole.size(); ++i) {
        const bool is_joint = whole[i] == ridge.joint[0] || whole[i] == ridge.joint[1];
        if (!is_joint && !candidates.contains(whole[i])) continue;
        if (last < i) {
            out.emplace_back(whole.begin() + static_cast<std::ptrdiff_t>(last),
                             whole.begin() + static_cast<std::ptrdiff_t>(i) + 1);
        }
        last = i;
    }
    return out;
}

// Ridge splitting. Gives the cells inserted and how many arcs end short of the threshold.
std::int64_t split_arcs(const TableJob& job, const OverlapRule& rule, const std::vector<Arc>& arcs,
                        Pool& pool, std::vector<std::int64_t>& inserted) {
    struct Stretch {
        std::size_t arc;
        std::size_t from;
        std::size_t to;
    };
    constexpr int depth_most = 16;
    const Grid& grid = job.layout().grid;
    std::vector<Stretch> open;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
        if (arcs[i].size() > 1) open.push_back({i, 0, arcs[i].size() - 1});
    }
    std::vector<std::uint8_t> falls_short(arcs.size(), 0);
    for (int depth = 0; !open.empty(); ++depth) {
        std::vector<std::uint8_t> apart(open.size(), 0);
        job.threads.for_each(
            static_cast<std::int64_t>(open.size()), 16, [&](std::int64_t from, std::int64_t to) {
                for (std::int64_t i = from; i < to; ++i) {
                    const Stretch& p = open[idx(i)];
                    const Arc& arc = arcs[p.arc];
                    const double o =
                        overlap(rule.ratio, pool.row(arc[p.from]), pool.row(arc[p.to]));
                    apart[idx(i)] = rule.enough(o) ? 0 : 1;
                }
            });
        std::vector<Stretch> next;
        std::vector<std::int64_t> middles;
        for (std::size_t i = 0; i < open.size(); ++i) {
            if (apart[i] == 0) continue;
            const Stretch& p = open[i];
            if (p.to < p.from + 2 || depth == depth_most) {
                falls_short[p.arc] = 1;
                continue;
            }
            const std::size_t middle = arc_middle(grid, arcs[p.arc], p.from, p.to);
            middles.push_back(arcs[p.arc][middle]);
            next.push_back({p.arc, p.from, middle});
            next.push_back({p.arc, middle, p.to});
        }
        inserted.insert(inserted.end(), middles.begin(), middles.end());
        pool.add(std::move(middles));
        open = std::move(next);
    }
    return std::count(falls_short.begin(), falls_short.end(), 1);
}

// Ends of the tile's ridges that cover a piece which no joint covers.
std::vector<std::int64_t> useful_ends(const TableJob& job, const TileRidges& tile,
                                      const CoveredPieces& covered) {
    std::vector<std::int64_t> ends;
    for (const TileRidges::Line& ridge : tile.ridges) {
        if (ridge.ring) continue;
        if (ridge.joint[0] < 0) ends.push_back(ridge.cells.front());
        if (ridge.joint[1] < 0) ends.push_back(ridge.cells.back());
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    const std::vector<Vec2d> eyes = centres(job.layout().grid, ends);
    std::vector<std::uint8_t> useful(ends.size(), 0);
    job.scenes.each(job.threads, eyes, [&](std::size_t i, const Scene& scene) {
        for (const Seen& s : scene.look(eyes[i]).row) {
            if (!covered[idx(s.piece)]) useful[i] = 1;
        }
    });
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (useful[i] != 0) out.push_back(ends[i]);
    }
    return out;
}

// The candidates of one tile.
FoundTile splits_of_tile(const TableJob& job, const TileRidges& tile, const CoveredPieces& covered,
                         const OverlapRule& rule) {
    const Grid& grid = job.layout().grid;
    FoundTile found;
    for (const std::int64_t c : useful_ends(job, tile, covered)) {
        found.candidates.push_back({c, CandidateKind::end});
    }
    std::unordered_set<std::int64_t> on_ridges;
    for (const FoundCandidate& c : found.candidates) on_ridges.insert(c.cell);
    std::vector<Arc> arcs;
    for (const TileRidges::Line& ridge : tile.ridges) {
        for (const std::int64_t c : points_without_joint(grid, ridge)) on_ridges.insert(c);
        for (Arc& p : arcs_of(ridge, on_ridges)) arcs.push_back(std::move(p));
    }
    Pool pool(job);
    std::vector<std::int64_t> ends;
    for (const Arc& p : arcs) {
        ends.push_back(p.front());
        ends.push_back(p.back());
    }
    pool.add(std::move(ends));
    std::vector<std::int64_t> inserted;
    found.short_of_overlap = split_arcs(job, rule, arcs, pool, inserted);
    std::sort(inserted.begin(), inserted.end());
    for (const std::int64_t c : inserted) found.candidates.push_back({c, CandidateKind::split});
    return found;
}

}  // namespace

FoundTiles make_splits(const TableJob& job, const RidgeTiles& ridges, const FoundTiles& joints,
                       const std::vector<Candidate>& of_user, const OverlapRule& rule,
                       std::int64_t pieces) {
    const Layout& layout = job.layout();
    CoveredPieces covered(idx(pieces), false);
    joints.mark_covered(covered);
    const ShardNames names = job.passing("splits");
    make_shards(job, names, layout.tiles(),
                [&](std::int64_t number, const std::filesystem::path& path) {
                    FoundTile found = splits_of_tile(job, ridges.tile(number), covered, rule);
                    std::vector<Vec2d> eyes;
                    for (const Candidate& c : of_user) {
                        if (layout.tile_of(layout.cell_at(c.at)) == number) eyes.push_back(c.at);
                    }
                    for (const FoundCandidate& c : found.candidates) {
                        eyes.push_back(layout.grid.centre(c.cell));
                    }
                    found.covered = covered_from(job, eyes, pieces);
                    write_found_tile(path, job.key, found);
                });
    return {names, layout.tiles()};
}

}  // namespace vfplan
