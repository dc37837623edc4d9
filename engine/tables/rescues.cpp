#include "engine/tables/rescues.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "engine/tables/best_cell.h"
#include "engine/tables/covered.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// A piece that nothing covers yet.
struct OpenPiece {
    std::int32_t of_site;  // its number
    std::int64_t patch;
    std::int32_t of_scene;  // its number in the patch's scene
};

// Pieces that nobody covers and whose middle lies in the window, in their order. What lies beyond
// the grid by more than rounding, on a part of a site, is another part's to rescue.
std::vector<OpenPiece> open_pieces(const TableJob& job, const SiteStore& site, const Window& window,
                                   const CoveredPieces& covered) {
    const Layout& layout = job.layout();
    const Grid& grid = layout.grid;
    const Vec2d rounding(grid.cell_m, grid.cell_m);
    const Box near_grid{grid.origin - rounding,
                        grid.origin + grid.cell_m * Vec2d(grid.nx, grid.ny) + rounding};
    std::vector<OpenPiece> out;
    for (const std::int64_t patch : layout.patches_in(window)) {
        if (!site.has_walls(patch)) continue;
        const PatchSite near = site.patch(patch);
        std::int32_t local = 0;
        for (std::size_t w = 0; w < near.walls.size(); ++w) {
            for (const Side side : {left, right}) {
                if (near.first[side][w] < 0) continue;
                const std::int32_t n = near.count[w];
                const double length = near.walls[w].length_m();
                for (std::int32_t k = 0; k < n; ++k, ++local) {
                    if (covered[idx(near.first[side][w] + k)]) continue;
                    const Vec2d middle = near.walls[w].at(
                        (piece_begin_m(length, k, n) + piece_begin_m(length, k + 1, n)) / 2);
                    if (!near_grid.contains(middle)) continue;
                    const std::int64_t cell = layout.cell_at(middle);
                    if (layout.patch_of(cell) != patch) continue;
                    if (!window.contains(layout.grid.ix(cell), layout.grid.iy(cell))) continue;
                    out.push_back({near.first[side][w] + k, patch, local});
                }
            }
        }
    }
    std::sort(out.begin(), out.end(),
              [](const OpenPiece& a, const OpenPiece& b) { return a.of_site < b.of_site; });
    return out;
}

// The cells around a window that can see something in it.
FieldWindow field_around(const TableJob& job, const FieldTiles& tiles, const Window& window) {
    constexpr std::int32_t rounding = 2;
    const auto piece_cells = static_cast<std::int32_t>(
        std::ceil(job.scenes.options().partition_m / job.layout().grid.cell_m));
    return tiles.window(
        window.grown(job.range_cells() + rounding + piece_cells, job.layout().grid));
}

// One cell often serves many pieces. Takes cells in the order of pieces, and looks for none where a
// piece is covered by then.
RescueTile rescues_of_tile(const TableJob& job, const SiteStore& site, const FieldTiles& tiles,
                           double threshold_rad, const CoveredPieces& covered, std::int64_t tile) {
    const Layout& layout = job.layout();
    const Window core = layout.tile_window(tile);
    const std::vector<OpenPiece> open = open_pieces(job, site, core, covered);
    RescueTile out;
    if (open.empty()) return out;
    const FieldWindow field = field_around(job, tiles, core);
    // A few at a time are looked for together, some of them in vain: with other tiles at work there
    // is enough to do.
    const std::int64_t threads = job.threads.count();
    const auto at_once = static_cast<std::size_t>(
        std::max<std::int64_t>(2, 2 * threads / std::min<std::int64_t>(threads, layout.tiles())));
    std::unordered_set<std::int32_t> rescued;
    std::vector<std::size_t> batch;
    std::vector<std::pair<std::int64_t, std::vector<std::int32_t>>> cells;
    for (const OpenPiece& o : open) out.piece.push_back(o.of_site);
    out.piece_cell.resize(open.size(), RescueTile::rescued);
    for (std::size_t next = 0; next < open.size();) {
        batch.clear();
        for (; next < open.size() && batch.size() < at_once; ++next) {
            if (!rescued.contains(open[next].of_site)) batch.push_back(next);
        }
        std::vector<BestCell> found(batch.size());
        job.threads.for_each(
            static_cast<std::int64_t>(batch.size()), 1, [&](std::int64_t from, std::int64_t to) {
                for (std::size_t i = idx(from); i < idx(to); ++i) {
                    const OpenPiece& o = open[batch[i]];
                    const auto scene = job.scenes.of_patch(o.patch);
                    found[i] = best_cell(job, *scene, field, threshold_rad, o.of_scene);
                }
            });
        for (std::size_t i = 0; i < batch.size(); ++i) {
            if (rescued.contains(open[batch[i]].of_site)) continue;
            out.piece_cell[batch[i]] = found[i].cell;
            if (found[i].cell < 0) continue;
            auto& covers = cells.emplace_back(found[i].cell, std::vector<std::int32_t>{}).second;
            for (const Seen& s : found[i].row) {
                if (covered[idx(s.piece)]) continue;
                covers.push_back(s.piece);
                rescued.insert(s.piece);
            }
        }
    }
    std::sort(cells.begin(), cells.end());
    for (auto& [cell, covers] : cells) {
        out.cells.cell.push_back(cell);
        out.cells.covers.push_back(std::move(covers));
    }
    return out;
}

// All candidates of the phases before, each cell once: the kind that comes first stays.
std::vector<Candidate> found_before(const Grid& grid, const FoundTiles& joints,
                                    const FoundTiles& splits) {
    std::vector<FoundCandidate> found = joints.candidates();
    const std::vector<FoundCandidate> more = splits.candidates();
    found.insert(found.end(), more.begin(), more.end());
    std::sort(found.begin(), found.end(), [](const FoundCandidate& a, const FoundCandidate& b) {
        return std::pair(a.cell, a.kind) < std::pair(b.cell, b.kind);
    });
    std::vector<Candidate> out;
    std::int64_t last = -1;
    for (const FoundCandidate& c : found) {
        if (c.cell != last) out.push_back({grid.centre(c.cell), c.cell, c.kind, 0});
        last = c.cell;
    }
    return out;
}

struct Rescues {
    std::vector<Candidate> candidates;
    std::int64_t pieces = 0;  // that they cover
};

// The same over all tiles. A cell of a tile may do without when a piece before it, of another tile,
// is rescued by a cell that covers its own: what it would have covered is looked for here then.
class FewestCells {
public:
    FewestCells(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                double threshold_rad)
        : job_(job), site_(site), field_(field), threshold_rad_(threshold_rad) {}

    Rescues choose(const ShardNames& names, const CoveredPieces& covered) {
        std::vector<Open> open;
        std::unordered_map<std::int64_t, std::vector<std::int32_t>> covers;
        for (std::int64_t number = 0; number < job_.layout().tiles(); ++number) {
            RescueTile tile = read_rescue_tile(names.one(number));
            for (std::size_t i = 0; i < tile.piece.size(); ++i) {
                open.push_back({tile.piece[i], tile.piece_cell[i], number});
            }
            for (std::size_t i = 0; i < tile.cells.cell.size(); ++i) {
                covers[tile.cells.cell[i]] = std::move(tile.cells.covers[i]);
            }
        }
        std::sort(open.begin(), open.end(),
                  [](const Open& a, const Open& b) { return a.piece < b.piece; });
        std::unordered_set<std::int32_t> rescued;
        Rescues out;
        for (const Open& o : open) {
            if (o.cell == RescueTile::none || rescued.contains(o.piece)) continue;
            std::int64_t cell = o.cell;
            if (cell == RescueTile::rescued) {
                const BestCell found = look_for(o, covered);
                cell = found.cell;
                if (cell < 0) continue;
                for (const Seen& s : found.row) rescued.insert(s.piece);
            } else {
                rescued.insert(covers[cell].begin(), covers[cell].end());
            }
            out.candidates.push_back(
                {job_.layout().grid.centre(cell), cell, CandidateKind::rescue, 0});
        }
        out.pieces = std::count_if(open.begin(), open.end(),
                                   [&](const Open& o) { return rescued.contains(o.piece); });
        return out;
    }

private:
    struct Open {
        std::int32_t piece;
        std::int64_t cell;
        std::int64_t tile;
    };

    BestCell look_for(const Open& o, const CoveredPieces& covered) {
        if (o.tile != tile_) {
            tile_ = o.tile;
            of_tile_ = open_pieces(job_, site_, job_.layout().tile_window(tile_), covered);
        }
        const auto place = std::lower_bound(
            of_tile_.begin(), of_tile_.end(), o.piece,
            [](const OpenPiece& a, std::int32_t piece) { return a.of_site < piece; });
        const FieldWindow field =
            field_around(job_, field_, job_.layout().patch_window(place->patch));
        return best_cell(job_, *job_.scenes.of_patch(place->patch), field, threshold_rad_,
                         place->of_scene);
    }

    const TableJob& job_;
    const SiteStore& site_;
    const FieldTiles& field_;
    double threshold_rad_;
    std::int64_t tile_ = -1;
    std::vector<OpenPiece> of_tile_;
};

}  // namespace

CandidateList make_rescues(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                           const FoundTiles& joints, const FoundTiles& splits,
                           const std::vector<Candidate>& of_user, double threshold_rad) {
    const Layout& layout = job.layout();
    const ShardNames names = job.passing("rescues");
    constexpr double field_bytes = 5;  // of a cell
    CoveredPieces covered(idx(site.facts().pieces), false);
    joints.mark_covered(covered);
    splits.mark_covered(covered);
    make_shards(
        job, names, layout.tiles(),
        [&](std::int64_t tile, const std::filesystem::path& path) {
            write_rescue_tile(path, job.key,
                              rescues_of_tile(job, site, field, threshold_rad, covered, tile));
        },
        field_bytes * layout.largest_window_cells(job.range_cells()));
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        std::vector<Candidate> all = found_before(layout.grid, joints, splits);
        const Rescues rescues = FewestCells(job, site, field, threshold_rad).choose(names, covered);
        all.insert(all.end(), rescues.candidates.begin(), rescues.candidates.end());
        write_candidate_list(path, job.key, layout, std::move(all), {0, rescues.pieces});
    });
    return {names.whole(), layout, of_user};
}

}  // namespace vfplan
