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

// A cell from which some of a piece may be seen.
struct Option {
    bool domain;  // VF above the threshold
    float vf;
    std::int64_t cell;  // of the whole grid

    // The better ones first: inside the domain, with the greatest VF.
    bool operator<(const Option& b) const {
        return std::tuple(!domain, -vf, cell) < std::tuple(!b.domain, -b.vf, b.cell);
    }
};

// A piece, looked at from points along it. `piece` is the scene's.
class PieceInSight {
public:
    PieceInSight(const TableJob& job, const Scene& scene, std::int32_t piece)
        : grid_(job.layout().grid), scene_(scene), scanner_(job.scenes.options().scanner) {
        const Pieces::Place place = scene.pieces().place(piece);
        const Wall& wall = scene.walls()[idx(place.wall)];
        const Vec2d e = (wall.b - wall.a).normalized();
        normal_ = place.side == left ? Vec2d(-e.y(), e.x()) : Vec2d(e.y(), -e.x());
        for (int k = 0; k < samples; ++k) {
            const double s = place.s0_m + (place.s1_m - place.s0_m) * (k + 0.5) / samples;
            points_.push_back(wall.at(s) + off_the_wall_m * normal_);
            sights_.emplace_back(scene, points_.back());
        }
        needed_ = std::max(1.0, job.scenes.options().visible_fraction * samples - 1);
        cos_limit_ = std::cos(scanner_.max_incidence_deg * pi / 180) - 1e-9;
    }

    // The cells in question, in no order.
    std::vector<Option> options(const FieldWindow& field, double threshold_rad) const;

    // From how many points a cell's centre is in sight; 0 when these are too few.
    int seen_from(const Vec2d& centre) const {
        int seen = 0;
        for (int k = 0; k < samples; ++k) {
            if (seen + samples - k < needed_) return 0;
            const Vec2d d = centre - points_[idx(k)];
            const double far = d.norm();
            if (far < scanner_.range_min_m || far > scanner_.range_max_m) continue;
            if (d.dot(normal_) < cos_limit_ * far) continue;
            if (sights_[idx(k)].sees(centre)) ++seen;
        }
        return seen < needed_ ? 0 : seen;
    }

private:
    const Grid& grid_;
    const Scene& scene_;
    const Scanner& scanner_;
    Vec2d normal_;
    std::vector<Vec2d> points_;
    std::vector<Sight> sights_;
    double needed_ = 1;
    double cos_limit_ = 0;
};

std::vector<Option> PieceInSight::options(const FieldWindow& field, double threshold_rad) const {
    const Vec2d corner = grid_.origin - scene_.origin();
    const auto column = [&](double x) {
        return static_cast<std::int32_t>(std::clamp(std::floor((x - corner.x()) / grid_.cell_m),
                                                    0.0, static_cast<double>(grid_.nx - 1)));
    };
    const auto row = [&](double y) {
        return static_cast<std::int32_t>(std::clamp(std::floor((y - corner.y()) / grid_.cell_m),
                                                    0.0, static_cast<double>(grid_.ny - 1)));
    };
    Box box;
    for (const Sight& s : sights_) {
        const Box reach = s.reach(scanner_.range_max_m);
        box.add(reach.min);
        box.add(reach.max);
    }
    const std::int32_t first_row = row(box.min.y());
    const std::int32_t first_column = column(box.min.x());
    const std::int32_t last_column = column(box.max.x());
    std::vector<Sight::Stretches> in_sight(idx(row(box.max.y()) - first_row + 1));
    for (const Sight& s : sights_) {
        s.add_rows(scanner_.range_max_m, corner.y() + (first_row + 0.5) * grid_.cell_m,
                   grid_.cell_m, in_sight);
    }
    std::vector<Option> out;
    for (std::int32_t iy = first_row; iy <= row(box.max.y()); ++iy) {
        auto& stretches = in_sight[idx(iy - first_row)];
        std::sort(stretches.begin(), stretches.end());
        auto stretch = stretches.begin();
        for (std::int32_t ix = first_column; ix <= last_column; ++ix) {
            const double x = corner.x() + (ix + 0.5) * grid_.cell_m;
            // On to the next stretch that does not end before this cell.
            while (stretch != stretches.end() && stretch->second < x - grid_.cell_m) ++stretch;
            if (stretch == stretches.end()) break;
            if (stretch->first > x + grid_.cell_m) {
                ix = std::max(ix, column(stretch->first) - 1);
                continue;
            }
            if (!field.inside(ix, iy)) continue;  // beyond range, but for rounding
            const std::size_t i = field.index(ix, iy);
            if (std::isnan(field.vf_rad[i])) continue;
            const std::int64_t cell = grid_.id(ix, iy);
            if ((grid_.centre(cell) - scene_.origin() - points_[0]).dot(normal_) <= 0) continue;
            out.push_back({field.in_domain(i, threshold_rad), field.vf_rad[i], cell});
        }
    }
    return out;
}

bool covers(const CoverageRow& row, std::int32_t piece) {
    return std::binary_search(row.begin(), row.end(), Seen{piece, 0, 0},
                              [](const Seen& a, const Seen& b) { return a.piece < b.piece; });
}

// The first good cell, tried by real views; -1 when there is none. Inside the domain first, and
// there first those that see every point of the piece, which are nearly certain.
std::int64_t best_cell(const TableJob& job, const Scene& scene, const FieldWindow& field,
                       double threshold_rad, std::int32_t piece) {
    const PieceInSight in_sight(job, scene, piece);
    const Grid& grid = job.layout().grid;
    std::size_t tests = 0;
    const auto covers_it = [&](std::int64_t cell) {
        ++tests;
        return covers(job.scenes.look(grid.centre(cell)).row, scene.site_piece(piece));
    };
    // Most cells are never asked whether they see the piece: a heap gives the best one by one.
    const auto worse = [](const Option& a, const Option& b) { return b < a; };
    std::vector<Option> open = in_sight.options(field, threshold_rad);
    std::make_heap(open.begin(), open.end(), worse);
    std::vector<std::int64_t> partly;
    const auto best_of_partly = [&]() -> std::int64_t {
        for (const std::int64_t cell : partly) {
            if (tests >= tests_most) break;
            if (covers_it(cell)) return cell;
        }
        partly.clear();
        return -1;
    };
    bool domain = true;
    while (!open.empty() && tests < tests_most) {
        std::pop_heap(open.begin(), open.end(), worse);
        const Option o = open.back();
        open.pop_back();
        if (domain && !o.domain) {
            domain = false;
            if (const std::int64_t cell = best_of_partly(); cell >= 0) return cell;
            if (tests >= tests_most) return -1;
        }
        const int seen = in_sight.seen_from(grid.centre(o.cell) - scene.origin());
        if (seen == 0) continue;
        if (seen < samples) {
            partly.push_back(o.cell);
        } else if (covers_it(o.cell)) {
            return o.cell;
        }
    }
    return best_of_partly();
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
