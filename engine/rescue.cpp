#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "engine/candidate_tiles.h"
#include "engine/field_tiles.h"
#include "engine/tile_shards.h"
#include "kernels/angle.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr int samples = 8;               // points along a piece that are looked from
constexpr double off_the_wall_m = 2e-4;  // how far before the wall they lie
constexpr std::size_t tests_most = 200;  // real views from cells that look good

// What a point on a wall sees, for asking whether a cell is in sight of it. In the scene's frame.
class Sight {
public:
    Sight(const Scene& scene, const Vec2d& eye) : scene_(scene), eye_(eye) {
        scene.exact().first_hits(eye, view_);
        starts_.reserve(view_.size());
        for (const Span& s : view_) {
            starts_.push_back(pseudo_angle(wall(s).at(s.s_begin_m) - eye));
        }
        order_.resize(view_.size());
        std::iota(order_.begin(), order_.end(), 0U);
        std::sort(order_.begin(), order_.end(),
                  [&](std::size_t a, std::size_t b) { return starts_[a] < starts_[b]; });
    }

    bool sees(const Vec2d& p) const {
        if (view_.empty()) return true;
        const double angle = pseudo_angle(p - eye_);
        auto next = std::upper_bound(order_.begin(), order_.end(), angle,
                                     [&](double a, std::size_t i) { return a < starts_[i]; });
        const Span& s = view_[next == order_.begin() ? order_.back() : *std::prev(next)];
        const Vec2d from = wall(s).at(s.s_begin_m) - eye_;
        const Vec2d to = wall(s).at(s.s_end_m) - eye_;
        const Vec2d d = p - eye_;
        if (cross(from, d) < 0 || cross(d, to) < 0) return true;  // between spans: open
        return cross(to - from, d - from) > 0;                    // before the wall
    }

    // Everything in sight within range.
    Box reach(double range_m) const {
        Box box;
        box.add(eye_);
        const Vec2d r(range_m, range_m);
        double covered = 0;
        for (const Span& s : view_) {
            const Vec2d from = wall(s).at(s.s_begin_m) - eye_;
            const Vec2d to = wall(s).at(s.s_end_m) - eye_;
            covered += angle_between_rad(from, to);
            box.add(eye_ + from);
            box.add(eye_ + to);
        }
        if (covered < 2 * pi - 1e-6) return {eye_ - r, eye_ + r};
        box.min = box.min.cwiseMax(eye_ - r);
        box.max = box.max.cwiseMin(eye_ + r);
        return box;
    }

private:
    const Wall& wall(const Span& s) const { return scene_.walls()[at(s.wall)]; }

    const Scene& scene_;
    Vec2d eye_;
    View view_;
    std::vector<double> starts_;
    std::vector<std::size_t> order_;
};

struct Option {
    std::int64_t cell;  // of the whole grid
    int seen;           // sample points in sight
    bool domain;        // VF above the threshold
    float vf;
};

// The cells from which enough of a piece may be seen, the best first: inside the domain, with
// the greatest VF. `piece` is the scene's.
std::vector<Option> options_for(const Work& work, const Scene& scene, const FieldWindow& field,
                                std::int32_t piece) {
    const Grid& grid = work.layout().grid;
    const Pieces::Place place = scene.pieces().place(piece);
    const Wall& wall = scene.walls()[at(place.wall)];
    const Vec2d e = (wall.b - wall.a).normalized();
    const Vec2d normal = place.side == left ? Vec2d(-e.y(), e.x()) : Vec2d(e.y(), -e.x());
    const Scanner& scanner = work.scenes.options().scanner;
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
    const double needed = std::max(1.0, work.config.coverage.visible_fraction * samples - 1);
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
    for (std::int32_t iy = row(box.min.y()); iy <= row(box.max.y()); ++iy) {
        for (std::int32_t ix = column(box.min.x()); ix <= column(box.max.x()); ++ix) {
            if (!field.inside(ix, iy)) continue;  // beyond range, but for rounding
            const std::size_t i = field.index(ix, iy);
            if (std::isnan(field.vf_rad[i])) continue;
            const std::int64_t cell = grid.id(ix, iy);
            const Vec2d c = grid.centre(cell) - scene.origin();
            if ((c - points[0]).dot(normal) <= 0) continue;
            int seen = 0;
            for (int k = 0; k < samples; ++k) {
                if (seen + samples - k < needed) break;
                const Vec2d d = c - points[at(k)];
                const double far = d.norm();
                if (far < scanner.range_min_m || far > scanner.range_max_m) continue;
                if (d.dot(normal) < cos_limit * far) continue;
                if (sights[at(k)].sees(c)) ++seen;
            }
            if (seen < needed) continue;
            out.push_back(
                {cell, seen, field.in_domain(i, work.config.field.threshold_rad), field.vf_rad[i]});
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
std::int64_t best_cell(const Work& work, const Scene& scene, const FieldWindow& field,
                       std::int32_t piece) {
    std::vector<Option> options = options_for(work, scene, field, piece);
    // Cells that see every sample point are nearly certain; look at those first.
    std::stable_partition(options.begin(), options.end(),
                          [](const Option& o) { return o.seen == samples; });
    std::stable_partition(options.begin(), options.end(), [](const Option& o) { return o.domain; });
    for (std::size_t i = 0; i < std::min(options.size(), tests_most); ++i) {
        const Vec2d eye = work.layout().grid.centre(options[i].cell);
        if (covers(work.scenes.look(eye).row, scene.site_piece(piece))) return options[i].cell;
    }
    return -1;
}

// A piece that nothing covers yet, in the numbering of its patch's scene.
struct OpenPiece {
    std::int64_t patch;
    std::int32_t piece;
};

// Pieces that nobody covers and whose middle lies in the window, patch by patch.
std::vector<OpenPiece> open_pieces(const Work& work, const Window& window,
                                   const CoveredPieces& covered) {
    const Layout& layout = work.layout();
    std::vector<OpenPiece> out;
    for (const std::int64_t patch : layout.patches_in(window)) {
        if (!work.store.has_walls(patch)) continue;
        const PatchSite site = work.store.patch(patch);
        std::int32_t local = 0;
        for (std::size_t w = 0; w < site.walls.size(); ++w) {
            for (const Side side : {left, right}) {
                if (site.first[side][w] < 0) continue;
                const std::int32_t n = site.count[w];
                const double length = site.walls[w].length_m();
                for (std::int32_t k = 0; k < n; ++k, ++local) {
                    if (covered[at(site.first[side][w] + k)]) continue;
                    const Vec2d middle = site.walls[w].at(
                        (piece_begin_m(length, k, n) + piece_begin_m(length, k + 1, n)) / 2);
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

// work/rescue-TILE.h5: every open piece with its cell, and which open pieces each cell covers.
void rescue_tile(const Work& work, std::int64_t tile, const CoveredPieces& covered,
                 const std::filesystem::path& path) {
    const Layout& layout = work.layout();
    const Window core = layout.tile_window(tile);
    const std::vector<OpenPiece> open = open_pieces(work, core, covered);
    std::vector<std::int32_t> piece(open.size());
    std::vector<std::int64_t> cell(open.size(), -1);
    if (!open.empty()) {
        constexpr std::int32_t rounding = 2;
        const auto margin = work.range_cells() + rounding +
                            static_cast<std::int32_t>(
                                std::ceil(work.config.coverage.partition_m / layout.grid.cell_m));
        const FieldWindow field =
            read_field_window(work.dir, layout, core.grown(margin, layout.grid));
        work.threads.for_each(
            static_cast<std::int64_t>(open.size()), 2, [&](std::int64_t from, std::int64_t to) {
                for (std::int64_t i = from; i < to; ++i) {
                    const auto scene = work.scenes.of_patch(open[at(i)].patch);
                    piece[at(i)] = scene->site_piece(open[at(i)].piece);
                    cell[at(i)] = best_cell(work, *scene, field, open[at(i)].piece);
                }
            });
    }
    std::vector<std::int64_t> cells;
    for (const std::int64_t c : cell) {
        if (c >= 0) cells.push_back(c);
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    std::vector<Vec2d> eyes;
    for (const std::int64_t c : cells) eyes.push_back(layout.grid.centre(c));
    std::vector<std::vector<std::int32_t>> seen(cells.size());
    work.scenes.each(work.threads, eyes, [&](std::size_t i, const Scene& scene) {
        for (const SeenLength& s : scene.look(eyes[i]).seen) {
            if (!covered[at(s.piece)]) seen[i].push_back(s.piece);
        }
    });
    std::vector<std::int64_t> seen_begin = {0};
    std::vector<std::int32_t> seen_piece;
    for (const auto& row : seen) {
        seen_piece.insert(seen_piece.end(), row.begin(), row.end());
        seen_begin.push_back(static_cast<std::int64_t>(seen_piece.size()));
    }
    h5::Writer file = shard_writer(path, work.key);
    file.write("piece", piece);
    file.write("piece_cell", cell);
    file.write("cell", cells);
    file.write("seen_begin", seen_begin);
    file.write("seen_piece", seen_piece);
    finish_shard(file);
}

// All candidates of the phases before, each cell once: the kind that comes first stays.
std::vector<Candidate> candidates_so_far(const Work& work) {
    std::vector<TileCandidate> found;
    for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
        for (const char* phase : {"seeds", "ridges"}) {
            for (const TileCandidate& c : read_tile_candidates(work.passing(phase, tile))) {
                found.push_back(c);
            }
        }
    }
    std::sort(found.begin(), found.end(), [](const TileCandidate& a, const TileCandidate& b) {
        return std::pair(a.cell, a.kind) < std::pair(b.cell, b.kind);
    });
    std::vector<Candidate> out;
    std::int64_t last = -1;
    for (const TileCandidate& c : found) {
        if (c.cell != last) out.push_back({work.layout().grid.centre(c.cell), c.cell, c.kind, 0});
        last = c.cell;
    }
    return out;
}

// One cell often serves many pieces: takes cells in the order of pieces, skips what is covered by
// then.
void take_rescue_cells(const Work& work, std::vector<Candidate>& candidates) {
    std::vector<std::pair<std::int32_t, std::int64_t>> open;  // piece and its cell
    std::unordered_map<std::int64_t, std::vector<std::int32_t>> seen_from;
    for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
        const h5::Reader file(work.passing("rescue", tile));
        const auto piece = file.read<std::int32_t>("piece");
        const auto piece_cell = file.read<std::int64_t>("piece_cell");
        for (std::size_t i = 0; i < piece.size(); ++i) open.emplace_back(piece[i], piece_cell[i]);
        const auto cell = file.read<std::int64_t>("cell");
        const auto begin = file.read<std::int64_t>("seen_begin");
        const auto seen = file.read<std::int32_t>("seen_piece");
        for (std::size_t i = 0; i < cell.size(); ++i) {
            seen_from[cell[i]].assign(seen.begin() + begin[i], seen.begin() + begin[i + 1]);
        }
    }
    std::sort(open.begin(), open.end());
    std::unordered_map<std::int32_t, bool> covered;
    for (const auto& [piece, cell] : open) {
        if (cell < 0 || covered.contains(piece)) continue;
        candidates.push_back({work.layout().grid.centre(cell), cell, CandidateKind::rescue, 0});
        for (const std::int32_t p : seen_from[cell]) covered[p] = true;
    }
}

}  // namespace

void make_rescue(const Work& work) {
    {
        const CoveredPieces covered = covered_pieces(work, {"seeds", "ridges"});
        make_shards(
            work, "rescue", work.layout().tiles(),
            [&](std::int64_t tile) { return work.passing("rescue", tile); },
            [&](std::int64_t tile, const std::filesystem::path& path) {
                rescue_tile(work, tile, covered, path);
            });
    }
    make_shard(work, "candidates", list_path(work, found_list), [&](const std::filesystem::path&) {
        std::vector<Candidate> candidates = candidates_so_far(work);
        take_rescue_cells(work, candidates);
        write_list(work, found_list, std::move(candidates));
    });
}

}  // namespace vfplan
