#include "engine/candidate_tiles.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "engine/skeleton_tiles.h"
#include "engine/tile_shards.h"
#include "io/columns.h"
#include "kernels/index.h"
#include "kernels/ridges.h"

namespace vfplan {
namespace {

// The points that a ridge without joints stands for: the middle of a line, two opposite points
// of a ring.
std::vector<std::int64_t> points_without_joint(const Grid& grid, const TileRidges::Line& ridge) {
    const auto& cells = ridge.cells;
    if (ridge.joint[0] >= 0 || ridge.joint[1] >= 0) return {};
    if (ridge.ring && cells.size() > 2) {
        CellPath closed = cells;
        closed.push_back(cells.front());
        return {cells.front(), closed[arc_middle(grid, closed, 0, closed.size() - 1)]};
    }
    if (cells.size() < 3) return {cells.front()};
    return {cells[arc_middle(grid, cells, 0, cells.size() - 1)]};
}

// Candidates of one tile's ridges while they are split, with their rows.
class Pool {
public:
    explicit Pool(const Work& work) : work_(work) {}

    // Looks from the cells that are not in it yet.
    void add(std::vector<std::int64_t> cells) {
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        std::erase_if(cells, [&](std::int64_t c) { return rows_.contains(c); });
        std::vector<Vec2d> eyes;
        for (const std::int64_t c : cells) eyes.push_back(work_.layout().grid.centre(c));
        std::vector<OverlapRow> rows = work_.scenes.overlap_rows(work_.threads, eyes);
        for (std::size_t i = 0; i < cells.size(); ++i) rows_.emplace(cells[i], std::move(rows[i]));
    }
    bool has(std::int64_t cell) const { return rows_.contains(cell); }
    const OverlapRow& row(std::int64_t cell) const { return rows_.at(cell); }

private:
    const Work& work_;
    std::unordered_map<std::int64_t, OverlapRow> rows_;
};

// The ridge as paths from candidate to candidate: through its joints and the candidates on it.
std::vector<CellPath> paths_of(const TileRidges::Line& ridge,
                               const std::unordered_set<std::int64_t>& candidates) {
    CellPath whole;
    if (ridge.joint[0] >= 0) whole.push_back(ridge.joint[0]);
    whole.insert(whole.end(), ridge.cells.begin(), ridge.cells.end());
    if (ridge.joint[1] >= 0) whole.push_back(ridge.joint[1]);
    if (ridge.ring) whole.push_back(ridge.cells.front());
    std::vector<CellPath> out;
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

// Ridge splitting. Tells the cells inserted and how many paths end short of the threshold.
std::int64_t split_paths(const Work& work, const std::vector<CellPath>& paths, Pool& pool,
                         std::vector<std::int64_t>& inserted) {
    struct Part {
        std::size_t path;
        std::size_t from;
        std::size_t to;
    };
    constexpr int depth_most = 16;
    const Grid& grid = work.layout().grid;
    std::vector<Part> open;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (paths[i].size() > 1) open.push_back({i, 0, paths[i].size() - 1});
    }
    std::vector<std::uint8_t> falls_short(paths.size(), 0);
    for (int depth = 0; !open.empty(); ++depth) {
        std::vector<std::uint8_t> apart(open.size(), 0);
        work.threads.for_each(
            static_cast<std::int64_t>(open.size()), 16, [&](std::int64_t from, std::int64_t to) {
                for (std::int64_t i = from; i < to; ++i) {
                    const Part& p = open[at(i)];
                    const CellPath& path = paths[p.path];
                    const double o =
                        overlap(work.ratio(), pool.row(path[p.from]), pool.row(path[p.to]));
                    apart[at(i)] = o < work.threshold() ? 1 : 0;
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
        inserted.insert(inserted.end(), middles.begin(), middles.end());
        pool.add(std::move(middles));
        open = std::move(next);
    }
    return std::count(falls_short.begin(), falls_short.end(), 1);
}

// Ends of the tile's ridges that cover a piece which no seed covers.
std::vector<std::int64_t> useful_ends(const Work& work, const TileRidges& tile,
                                      const CoveredPieces& covered) {
    std::vector<std::int64_t> ends;
    for (const TileRidges::Line& ridge : tile.ridges) {
        if (ridge.ring) continue;
        if (ridge.joint[0] < 0) ends.push_back(ridge.cells.front());
        if (ridge.joint[1] < 0) ends.push_back(ridge.cells.back());
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    std::vector<Vec2d> eyes;
    for (const std::int64_t c : ends) eyes.push_back(work.layout().grid.centre(c));
    std::vector<std::uint8_t> useful(ends.size(), 0);
    work.scenes.each(work.threads, eyes, [&](std::size_t i, const Scene& scene) {
        for (const SeenLength& s : scene.look(eyes[i]).seen) {
            if (!covered[at(s.piece)]) useful[i] = 1;
        }
    });
    std::vector<std::int64_t> out;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        if (useful[i] != 0) out.push_back(ends[i]);
    }
    return out;
}

}  // namespace

void make_seeds(const Work& work) {
    const Layout& layout = work.layout();
    make_shards(
        work, "joints", layout.tiles(),
        [&](std::int64_t tile) { return work.passing("seeds", tile); },
        [&](std::int64_t tile, const std::filesystem::path& path) {
            const TileRidges ridges = read_tile_ridges(work, tile);
            std::vector<TileCandidate> seeds;
            for (const std::int64_t c : ridges.joints) seeds.push_back({c, CandidateKind::joint});
            for (const TileRidges::Line& ridge : ridges.ridges) {
                for (const std::int64_t c : points_without_joint(layout.grid, ridge)) {
                    seeds.push_back({c, ridge.ring ? CandidateKind::ring : CandidateKind::middle});
                }
            }
            write_tile_candidates(work, path, seeds, covered_from(work, seeds, {}), 0);
        });
}

void make_ridge_points(const Work& work) {
    const Layout& layout = work.layout();
    const CoveredPieces covered = covered_pieces(work, {"seeds"});
    const std::vector<Candidate> of_user = points_of_user(work);
    make_shards(
        work, "ridges", layout.tiles(),
        [&](std::int64_t tile) { return work.passing("ridges", tile); },
        [&](std::int64_t tile, const std::filesystem::path& path) {
            const TileRidges ridges = read_tile_ridges(work, tile);
            std::vector<TileCandidate> found;
            for (const std::int64_t c : useful_ends(work, ridges, covered)) {
                found.push_back({c, CandidateKind::end});
            }
            std::unordered_set<std::int64_t> on_ridges;
            for (const TileCandidate& c : found) on_ridges.insert(c.cell);
            std::vector<CellPath> paths;
            for (const TileRidges::Line& ridge : ridges.ridges) {
                for (const std::int64_t c : points_without_joint(layout.grid, ridge)) {
                    on_ridges.insert(c);
                }
                for (CellPath& p : paths_of(ridge, on_ridges)) paths.push_back(std::move(p));
            }
            Pool pool(work);
            std::vector<std::int64_t> ends;
            for (const CellPath& p : paths) {
                ends.push_back(p.front());
                ends.push_back(p.back());
            }
            pool.add(std::move(ends));
            std::vector<std::int64_t> inserted;
            const std::int64_t falls_short = split_paths(work, paths, pool, inserted);
            std::sort(inserted.begin(), inserted.end());
            for (const std::int64_t c : inserted) found.push_back({c, CandidateKind::split});
            std::vector<Vec2d> users;
            for (const Candidate& c : of_user) {
                if (layout.tile_of(layout.cell_at(c.at)) == tile) users.push_back(c.at);
            }
            write_tile_candidates(work, path, found, covered_from(work, found, users), falls_short);
        });
}

std::vector<Candidate> points_of_user(const Work& work) {
    std::vector<Candidate> out;
    const Vec2d& origin = work.store.facts().origin;
    for (const Vec2d& p : work.config.plan.required) {
        out.push_back({p - origin, -1, CandidateKind::required, 0});
    }
    for (const Vec2d& p : work.config.plan.existing) {
        out.push_back({p - origin, -1, CandidateKind::existing, 0});
    }
    return out;
}

std::filesystem::path list_path(const Work& work, std::int64_t list) {
    return work.passing("candidates", list);
}

void write_list(const Work& work, std::int64_t list, std::vector<Candidate> candidates,
                std::int64_t parts) {
    const Layout& layout = work.layout();
    const auto patch_of = [&](const Candidate& c) { return layout.patch_of(layout.cell_at(c.at)); };
    std::stable_sort(candidates.begin(), candidates.end(),
                     [&](const Candidate& a, const Candidate& b) {
                         return std::tuple(patch_of(a), a.at.y(), a.at.x(), a.kind) <
                                std::tuple(patch_of(b), b.at.y(), b.at.x(), b.kind);
                     });
    candidates.erase(
        std::unique(candidates.begin(), candidates.end(),
                    [](const Candidate& a, const Candidate& b) { return a.at == b.at; }),
        candidates.end());
    std::vector<std::int64_t> begin(at(layout.patches()) + 1, 0);
    for (const Candidate& c : candidates) ++begin[at(patch_of(c)) + 1];
    for (std::size_t p = 0; p + 1 < begin.size(); ++p) begin[p + 1] += begin[p];
    constexpr std::uint64_t chunk = 1U << 12;
    h5::Writer file = shard_writer(list_path(work, list), work.key);
    file.attribute("/", "parts", parts);
    file.write("patch_begin", begin);
    const auto write = [&](const char* name, auto example, auto&& value) {
        file.write(name, column<decltype(example)>(candidates, value), {}, chunk);
    };
    write("x", double{}, [](const Candidate& c) { return c.at.x(); });
    write("y", double{}, [](const Candidate& c) { return c.at.y(); });
    write("cell", std::int64_t{}, [](const Candidate& c) { return c.cell; });
    write("kind", std::uint8_t{}, [](const Candidate& c) { return c.kind; });
    finish_shard(file);
}

namespace {

std::vector<Candidate> read_some(const h5::Reader& file, std::uint64_t from, std::uint64_t count) {
    const auto x = file.read<double>("x", from, count);
    const auto y = file.read<double>("y", from, count);
    const auto cell = file.read<std::int64_t>("cell", from, count);
    const auto kind = file.read<std::uint8_t>("kind", from, count);
    std::vector<Candidate> out;
    out.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        out.push_back({{x[i], y[i]}, cell[i], static_cast<CandidateKind>(kind[i]), 0});
    }
    return out;
}

}  // namespace

std::int64_t list_size(const Work& work, std::int64_t list) {
    return static_cast<std::int64_t>(h5::Reader(list_path(work, list)).dims("x").at(0));
}

std::vector<Candidate> read_list(const Work& work, std::int64_t list, std::int64_t from,
                                 std::int64_t count) {
    return read_some(h5::Reader(list_path(work, list)), static_cast<std::uint64_t>(from),
                     static_cast<std::uint64_t>(count));
}

ListPart read_list(const Work& work, std::int64_t list, const Window& window) {
    const h5::Reader file(list_path(work, list));
    const auto begin = file.read<std::int64_t>("patch_begin");
    ListPart out;
    const std::vector<std::int64_t> patches = work.layout().patches_in(window);
    for (std::size_t i = 0; i < patches.size();) {
        std::size_t k = i + 1;  // patches beside each other in one go
        while (k < patches.size() && patches[k] == patches[k - 1] + 1) ++k;
        const std::int64_t from = begin[at(patches[i])];
        const std::int64_t to = begin[at(patches[k - 1]) + 1];
        for (std::int64_t n = from; n < to; ++n) {
            out.number.push_back(static_cast<std::int32_t>(n));
        }
        const std::vector<Candidate> some = read_some(file, static_cast<std::uint64_t>(from),
                                                      static_cast<std::uint64_t>(to - from));
        out.candidates.insert(out.candidates.end(), some.begin(), some.end());
        i = k;
    }
    const std::vector<Candidate> users = points_of_user(work);
    for (std::size_t i = 0; i < users.size(); ++i) {
        const std::int64_t patch = work.layout().patch_of(work.layout().cell_at(users[i].at));
        if (!std::binary_search(patches.begin(), patches.end(), patch)) continue;
        out.number.push_back(
            static_cast<std::int32_t>(begin.back() + static_cast<std::int64_t>(i)));
        out.candidates.push_back(users[i]);
    }
    return out;
}

void add_candidate_counts(const Work& work, CandidateReport& report) {
    const RidgeCounts ridges = count_ridges(work);
    report.joints = ridges.joints;
    report.ridges = ridges.ridges;
    for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
        report.ridges_short_of_overlap += static_cast<std::int64_t>(
            h5::Reader(work.passing("ridges", tile)).number("/", "falls_short"));
    }
}

}  // namespace vfplan
