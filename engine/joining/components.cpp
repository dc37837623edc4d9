#include "engine/joining/components.h"

#include <algorithm>
#include <cmath>

#include "kernels/disjoint_sets.h"
#include "kernels/index.h"
#include "kernels/overlap_rows.h"

namespace vfplan {
namespace {

// A candidate of the list in or around a tile.
struct Near {
    std::int32_t number;
    Vec2d eye;
    bool own;  // in the tile
};

// Candidates from which something may be seen that one of the tile's sees too.
std::vector<Near> candidates_near(const TableJob& job, const CandidateList& candidates,
                                  std::int64_t tile) {
    const Layout& layout = job.layout();
    const Grid& grid = layout.grid;
    const Window core = layout.tile_window(tile);
    // Two that see a piece in common are at most this far apart.
    const SceneOptions& o = job.scenes.options();
    const double far_m = 2 * o.scanner.range_max_m + o.partition_m;
    const auto margin = static_cast<std::int32_t>(std::ceil(far_m / grid.cell_m)) + 1;
    const Window around = core.grown(margin, grid);
    const CandidateList::Part list = candidates.in(around);
    std::vector<Near> out;
    for (std::size_t i = 0; i < list.number.size(); ++i) {
        const std::int64_t cell = layout.cell_at(list.candidates[i].at);
        const std::int32_t x = grid.ix(cell);
        const std::int32_t y = grid.iy(cell);
        if (!around.contains(x, y)) continue;
        out.push_back({list.number[i], list.candidates[i].at, core.contains(x, y)});
    }
    return out;
}

// Pairs of candidates that overlap enough, one of them in the tile: of all such pairs so many that
// they connect what all of them connect.
CandidatePairs connecting_pairs(const TableJob& job, const CandidateList& candidates,
                                const OverlapRule& rule, std::int64_t tile) {
    const std::vector<Near> near = candidates_near(job, candidates, tile);
    std::vector<Vec2d> eyes;
    for (const Near& n : near) eyes.push_back(n.eye);
    const LocalRows local = local_rows(job.scenes.overlap_rows(job.threads, eyes));
    const std::vector<SeenTotal> totals = seen_totals(local.rows, local.piece_length_m);
    const PieceIndex index =
        index_of(local.rows, static_cast<std::int64_t>(local.piece_length_m.size()));
    std::vector<std::vector<std::int32_t>> found(near.size());  // the later ones of each pair
    job.threads.for_each(local.rows.size(), 64, [&](std::int64_t from, std::int64_t to) {
        PairSearch search(local.rows, index, local.piece_length_m, formula(rule.ratio).by_angle);
        for (std::int64_t i = from; i < to; ++i) {
            search.after(
                static_cast<std::int32_t>(i),
                [&](std::int32_t n) { return near[idx(i)].own || near[idx(n)].own; },
                [&](std::int32_t n, const SeenJointly& joint) {
                    const double o = overlap(rule.ratio, totals[idx(i)], totals[idx(n)], joint);
                    if (rule.enough(o)) found[idx(i)].push_back(n);
                });
            std::sort(found[idx(i)].begin(), found[idx(i)].end());
        }
    });
    DisjointSets sets(static_cast<std::int64_t>(near.size()));
    CandidatePairs pairs;
    for (std::size_t i = 0; i < found.size(); ++i) {
        for (const std::int32_t n : found[i]) {
            if (sets.together(static_cast<std::int32_t>(i), n)) continue;
            sets.merge(static_cast<std::int32_t>(i), n);
            pairs.emplace_back(near[i].number, near[idx(n)].number);
        }
    }
    return pairs;
}

}  // namespace

Components make_components(const TableJob& job, const CandidateList& candidates,
                           const OverlapRule& rule, const std::string& variant) {
    const std::int64_t tiles = job.layout().tiles();
    const ShardNames names = job.passing("components", variant);
    make_shards(job, names, tiles, [&](std::int64_t tile, const std::filesystem::path& path) {
        write_pairs(path, job.key, connecting_pairs(job, candidates, rule, tile));
    });
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        const std::int64_t n = candidates.size();
        DisjointSets sets(n);
        for (std::int64_t tile = 0; tile < tiles; ++tile) {
            for (const auto& [a, b] : read_pairs(names.one(tile))) {
                if (!sets.together(a, b)) sets.merge(a, b);
            }
        }
        std::vector<std::int32_t> component(idx(n), -1);
        std::vector<std::int32_t> of_root(idx(n), -1);
        std::int32_t count = 0;
        for (std::int32_t c = 0; c < n; ++c) {
            std::int32_t& k = of_root[idx(sets.root(c))];
            if (k < 0) k = count++;
            component[idx(c)] = k;
        }
        write_components(path, job.key, component, count);
    });
    return Components(names.whole());
}

}  // namespace vfplan
