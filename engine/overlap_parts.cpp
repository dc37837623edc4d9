#include "engine/overlap_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "engine/disjoint_sets.h"
#include "engine/piece_rows.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

std::filesystem::path parts_path(const Work& work) { return work.passing("parts", 0); }

// Who sees a piece, for the pieces that some rows see.
class Viewers {
public:
    explicit Viewers(const std::vector<OverlapRow>& rows) {
        std::int32_t last = -1;
        first_ = std::numeric_limits<std::int32_t>::max();
        for (const OverlapRow& row : rows) {
            if (row.seen.empty()) continue;
            first_ = std::min(first_, row.seen.front().piece);
            last = std::max(last, row.seen.back().piece);
        }
        begin_.assign(at(std::max(0, last - first_ + 1)) + 1, 0);
        for (const OverlapRow& row : rows) {
            for (const SeenLength& s : row.seen) ++begin_[at(s.piece - first_) + 1];
        }
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        row_.resize(at(begin_.back()));
        std::vector<std::int32_t> next(begin_.begin(), begin_.end() - 1);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            for (const SeenLength& s : rows[i].seen) {
                row_[at(next[at(s.piece - first_)]++)] = static_cast<std::int32_t>(i);
            }
        }
    }
    // Ascending.
    std::span<const std::int32_t> of(std::int32_t piece) const {
        return {row_.data() + begin_[at(piece - first_)],
                row_.data() + begin_[at(piece - first_) + 1]};
    }

private:
    std::int32_t first_ = 0;
    std::vector<std::int32_t> begin_;
    std::vector<std::int32_t> row_;
};

// A candidate of the list in or around a tile.
struct Near {
    std::int32_t number;
    Vec2d eye;
    bool own;  // in the tile
};

// Candidates from which something may be seen that one of the tile's sees too.
std::vector<Near> candidates_near(const Work& work, std::int64_t tile) {
    const Layout& layout = work.layout();
    const Grid& grid = layout.grid;
    const Window core = layout.tile_window(tile);
    // Two that see a piece in common are at most this far apart.
    const double far_m = 2 * work.config.scanner.range_max_m + work.config.coverage.partition_m;
    const auto margin = static_cast<std::int32_t>(std::ceil(far_m / grid.cell_m)) + 1;
    const Window around = core.grown(margin, grid);
    const ListPart list = read_list(work, found_list, around);
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
// they connect what all of them connect. Numbers of the list, two and two.
std::vector<std::int32_t> connecting_pairs(const Work& work, std::int64_t tile) {
    const std::vector<Near> near = candidates_near(work, tile);
    std::vector<Vec2d> eyes;
    for (const Near& n : near) eyes.push_back(n.eye);
    const std::vector<OverlapRow> rows = work.scenes.overlap_rows(work.threads, eyes);
    const Viewers viewers(rows);
    const bool angles = by_angle(work.ratio());
    std::vector<std::vector<std::int32_t>> found(rows.size());  // the smaller ones of each pair
    work.threads.for_each(
        static_cast<std::int64_t>(rows.size()), 64, [&](std::int64_t from, std::int64_t to) {
            SharedLengths shared;
            for (std::int64_t i = from; i < to; ++i) {
                const OverlapRow& row = rows[at(i)];
                for (const SeenLength& s : row.seen) {
                    for (const std::int32_t other : viewers.of(s.piece)) {
                        if (other >= i) break;
                        shared.add(other, s.length_m);
                    }
                }
                shared.take([&](std::int32_t other, double length_m) {
                    const Near& a = near[at(i)];
                    const Near& b = near[at(other)];
                    if (!a.own && !b.own) return;
                    const double o = angles ? overlap(work.ratio(), rows[at(other)], row)
                                            : overlap(work.ratio(), rows[at(other)].total,
                                                      row.total, SeenJointly{length_m, 0, 0});
                    if (o > 0 && o >= work.threshold()) found[at(i)].push_back(other);
                });
                std::sort(found[at(i)].begin(), found[at(i)].end());
            }
        });
    DisjointSets sets(static_cast<std::int64_t>(rows.size()));
    std::vector<std::int32_t> pairs;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const std::int32_t other : found[i]) {
            if (sets.together(other, static_cast<std::int32_t>(i))) continue;
            sets.merge(other, static_cast<std::int32_t>(i));
            pairs.push_back(near[at(other)].number);
            pairs.push_back(near[i].number);
        }
    }
    return pairs;
}

}  // namespace

std::int64_t make_parts(const Work& work) {
    make_shards(
        work, "parts", work.layout().tiles(),
        [&](std::int64_t tile) { return work.passing("pairs", tile); },
        [&](std::int64_t tile, const std::filesystem::path& path) {
            h5::Writer file = shard_writer(path, work.key);
            file.write("pair", connecting_pairs(work, tile));
            finish_shard(file);
        });
    make_shard(work, "parts", parts_path(work), [&](const std::filesystem::path& path) {
        const std::int64_t n =
            list_size(work, found_list) + static_cast<std::int64_t>(points_of_user(work).size());
        DisjointSets sets(n);
        for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
            const auto pair = h5::Reader(work.passing("pairs", tile)).read<std::int32_t>("pair");
            for (std::size_t i = 0; i < pair.size(); i += 2) {
                if (!sets.together(pair[i], pair[i + 1])) sets.merge(pair[i], pair[i + 1]);
            }
        }
        std::vector<std::int32_t> part(at(n), -1);
        std::vector<std::int32_t> of_root(at(n), -1);
        std::int32_t count = 0;
        for (std::int32_t c = 0; c < n; ++c) {
            std::int32_t& p = of_root[at(sets.root(c))];
            if (p < 0) p = count++;
            part[at(c)] = p;
        }
        h5::Writer file = shard_writer(path, work.key);
        file.write("part", part, {}, 1U << 12);
        file.attribute("/", "count", std::int64_t{count});
        finish_shard(file);
    });
    return static_cast<std::int64_t>(h5::Reader(parts_path(work)).number("/", "count"));
}

std::vector<std::int32_t> read_parts(const Work& work, std::int64_t from, std::int64_t count) {
    return h5::Reader(parts_path(work))
        .read<std::int32_t>("part", static_cast<std::uint64_t>(from),
                            static_cast<std::uint64_t>(count));
}

}  // namespace vfplan
