#include "engine/tables/rescues.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>
#include <unordered_set>

#include "engine/tables/covered.h"
#include "engine/tables/sight.h"
#include "kernels/angle.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr int samples = 8;               // points along a piece that are looked from
constexpr double off_the_wall_m = 2e-4;  // how far before the wall they lie
constexpr std::size_t tests_most = 200;  // real views from cells that look good

struct Option {
    std::int64_t cell;  // of the whole grid
    int seen;           // sample points in sight
    bool domain;        // VF above the threshold
    float vf;
};

// The cells from which enough of a piece may be seen, the best first: inside the domain, with
// the greatest VF. `piece` is the scene's.
std::vector<Option> options_for(const TableJob& job, const Scene& scene, const FieldWindow& field,
                                double threshold_rad, std::int32_t piece) {
    const Grid& grid = job.layout().grid;
    const Pieces::Place place = scene.pieces().place(piece);
    const Wall& wall = scene.walls()[idx(place.wall)];
    const Vec2d e = (wall.b - wall.a).normalized();
    const Vec2d normal = place.side == left ? Vec2d(-e.y(), e.x()) : Vec2d(e.y(), -e.x());
    const Scanner& scanner = job.scenes.options().scanner;
    std::vector<Vec2d> points;
    std::vector<Sight> sights;
    Box box;
    for (int k = 0; k < samples; ++k) {
        const double s = place.s0_m + (place.s1_m - place.s0_m) * (k + 0.5) / samples;
        points.push_back(wall.at(s) + off_the_wall_m * normal);
        sights.emplace_back(scene, points.back());
        const Box reach = sights.back().reach(scanner.range_max_m);
        box.add(reach.min);
        box.add(reach.max);
    }
    const double needed = std::max(1.0, job.scenes.options().visible_fraction * samples - 1);
    const double cos_limit = std::cos(scanner.max_incidence_deg * pi / 180) - 1e-9;
    const Vec2d corner = grid.origin - scene.origin();
    const auto column = [&](double x) {
        return static_cast<std::int32_t>(std::clamp(std::floor((x - corner.x()) / grid.cell_m), 0.0,
                                                    static_cast<double>(grid.nx - 1)));
    };
    const auto row = [&](double y) {
        return static_cast<std::int32_t>(std::clamp(std::floor((y - corner.y()) / grid.cell_m), 0.0,
                                                    static_cast<double>(grid.ny - 1)));
    };
    std::vector<Option> out;
    const std::int32_t first_row = row(box.min.y());
    const std::int32_t first_column = column(box.min.x());
    const std::int32_t last_column = column(box.max.x());
    std::vector<Sight::Stretches> in_sight(idx(row(box.max.y()) - first_row + 1));
    for (const Sight& s : sights) {
        s.add_rows(scanner.range_max_m, corner.y() + (first_row + 0.5) * grid.cell_m, grid.cell_m,
                   in_sight);
    }
    for (std::int32_t iy = first_row; iy <= row(box.max.y()); ++iy) {
        auto& stretches = in_sight[idx(iy - first_row)];
        std::sort(stretches.begin(), stretches.end());
        auto stretch = stretches.begin();
        for (std::int32_t ix = first_column; ix <= last_column; ++ix) {
            const double x = corner.x() + (ix + 0.5) * grid.cell_m;
            // On to the next stretch that does not end before this cell.
            while (stretch != stretches.end() && stretch->second < x - grid.cell_m) ++stretch;
            if (stretch == stretches.end()) break;
            if (stretch->first > x + grid.cell_m) {
                ix = std::max(ix, column(stretch->first) - 1);
                continue;
            }
            if (!field.inside(ix, iy)) continue;  // beyond range, but for rounding
            const std::size_t i = field.index(ix, iy);
            if (std::isnan(field.vf_rad[i])) continue;
            const std::int64_t cell = grid.id(ix, iy);
            const Vec2d c = grid.centre(cell) - scene.origin();
            if ((c - points[0]).dot(normal) <= 0) continue;
            int seen = 0;
            for (int k = 0; k < samples; ++k) {
                if (seen + samples - k < needed) break;
                const Vec2d d = c - points[idx(k)];
                const double far = d.norm();
                if (far < scanner.range_min_m || far > scanner.range_max_m) continue;
                if (d.dot(normal) < cos_limit * far) continue;
                if (sights[idx(k)].sees(c)) ++seen;
            }
            if (seen < needed) continue;
            out.push_back({cell, seen, field.in_domain(i, threshold_rad), field.vf_rad[i]});
        }
    }
    std::sort(out.begin(), out.end(), [&](const Option& a, const Option& b) {
        return std::tuple(!a.domain, -a.vf, a.cell) < std::tuple(!b.domain, -b.vf, b.cell);
    });
    return out;
}

bool covers(const CoverageRow& row, std::int32_t piece) {
    return std::binary_search(row.begin(), row.end(), Seen{piece, 0, 0},
                              [](const Seen& a, const Seen& b) { return a.piece < b.piece; });
}

// The first good cell, tried by real views; -1 when there is none.
std::int64_t best_cell(const TableJob& job, const Scene& scene, const FieldWindow& field,
                       double threshold_rad, std::int32_t piece) {
    std::vector<Option> options = options_for(job, scene, field, threshold_rad, piece);
    // Cells that see every sample point are nearly certain; look at those first.
    std::stable_partition(options.begin(), options.end(),
                          [](const Option& o) { return o.seen == samples; });
    std::stable_partition(options.begin(), options.end(), [](const Option& o) { return o.domain; });
    for (std::size_t i = 0; i < std::min(options.size(), tests_most); ++i) {
        const Vec2d eye = job.layout().grid.centre(options[i].cell);
        if (covers(job.scenes.look(eye).row, scene.site_piece(piece))) return options[i].cell;
    }
    return -1;
}

// A piece that nothing covers yet, in the numbering of its patch's scene.
struct OpenPiece {
    std::int64_t patch;
    std::int32_t piece;
};

// Pieces that nobody covers and whose middle lies in the window, patch by patch. What lies beyond
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
                    out.push_back({patch, local});
                }
            }
        }
    }
    return out;
}

RescueTile rescues_of_tile(const TableJob& job, const SiteStore& site, const FieldTiles& tiles,
                           double threshold_rad, const CoveredPieces& covered, std::int64_t tile) {
    const Layout& layout = job.layout();
    const Window core = layout.tile_window(tile);
    const std::vector<OpenPiece> open = open_pieces(job, site, core, covered);
    RescueTile out;
    out.piece.resize(open.size());
    out.piece_cell.resize(open.size(), -1);
    if (!open.empty()) {
        constexpr std::int32_t rounding = 2;
        const auto piece_cells = static_cast<std::int32_t>(
            std::ceil(job.scenes.options().partition_m / layout.grid.cell_m));
        const std::int32_t margin = job.range_cells() + rounding + piece_cells;
        const FieldWindow field = tiles.window(core.grown(margin, layout.grid));
        job.threads.for_each(
            static_cast<std::int64_t>(open.size()), 2, [&](std::int64_t from, std::int64_t to) {
                for (std::int64_t i = from; i < to; ++i) {
                    const auto scene = job.scenes.of_patch(open[idx(i)].patch);
                    out.piece[idx(i)] = scene->site_piece(open[idx(i)].piece);
                    out.piece_cell[idx(i)] =
                        best_cell(job, *scene, field, threshold_rad, open[idx(i)].piece);
                }
            });
    }
    for (const std::int64_t c : out.piece_cell) {
        if (c >= 0) out.cells.cell.push_back(c);
    }
    std::vector<std::int64_t>& cell = out.cells.cell;
    std::sort(cell.begin(), cell.end());
    cell.erase(std::unique(cell.begin(), cell.end()), cell.end());
    const std::vector<Vec2d> eyes = centres(layout.grid, cell);
    out.cells.covers.resize(cell.size());
    job.scenes.each(job.threads, eyes, [&](std::size_t i, const Scene& scene) {
        for (const Seen& s : scene.look(eyes[i]).row) {
            if (!covered[idx(s.piece)]) out.cells.covers[i].push_back(s.piece);
        }
    });
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

// One cell often serves many pieces: takes cells in the order of pieces, skips what is covered by
// then.
std::vector<Candidate> fewest_cells(const Grid& grid, const ShardNames& names, std::int64_t tiles) {
    std::vector<std::pair<std::int32_t, std::int64_t>> open;  // piece and its cell
    std::unordered_map<std::int64_t, std::vector<std::int32_t>> covers;
    for (std::int64_t number = 0; number < tiles; ++number) {
        RescueTile tile = read_rescue_tile(names.one(number));
        for (std::size_t i = 0; i < tile.piece.size(); ++i) {
            open.emplace_back(tile.piece[i], tile.piece_cell[i]);
        }
        for (std::size_t i = 0; i < tile.cells.cell.size(); ++i) {
            covers[tile.cells.cell[i]] = std::move(tile.cells.covers[i]);
        }
    }
    std::sort(open.begin(), open.end());
    std::unordered_set<std::int32_t> covered;
    std::vector<Candidate> out;
    for (const auto& [piece, cell] : open) {
        if (cell < 0 || covered.contains(piece)) continue;
        out.push_back({grid.centre(cell), cell, CandidateKind::rescue, 0});
        covered.insert(covers[cell].begin(), covers[cell].end());
    }
    return out;
}

}  // namespace

Rescued make_rescues(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                     const FoundTiles& joints, const FoundTiles& splits,
                     const std::vector<Candidate>& of_user, double threshold_rad) {
    const Layout& layout = job.layout();
    const ShardNames names = job.passing("rescues");
    {
        CoveredPieces covered(idx(site.facts().pieces), false);
        joints.mark_covered(covered);
        splits.mark_covered(covered);
        make_shards(
            job, names, layout.tiles(), [&](std::int64_t tile, const std::filesystem::path& path) {
                write_rescue_tile(path, job.key,
                                  rescues_of_tile(job, site, field, threshold_rad, covered, tile));
            });
    }
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        std::vector<Candidate> all = found_before(layout.grid, joints, splits);
        const std::vector<Candidate> rescues = fewest_cells(layout.grid, names, layout.tiles());
        all.insert(all.end(), rescues.begin(), rescues.end());
        write_candidate_list(path, job.key, layout, std::move(all));
    });
    Rescued out{{names.whole(), layout, of_user}, 0};
    for (std::int64_t tile = 0; tile < layout.tiles(); ++tile) {
        const std::vector<std::int64_t> cells = read_rescue_tile(names.one(tile)).piece_cell;
        out.pieces +=
            std::count_if(cells.begin(), cells.end(), [](std::int64_t c) { return c >= 0; });
    }
    return out;
}

}  // namespace vfplan
