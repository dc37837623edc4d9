#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/candidates.h"
#include "kernels/angle.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr int samples = 8;               // points along a piece that are looked from
constexpr double off_the_wall_m = 2e-4;  // how far before the wall they lie
constexpr std::size_t tests_most = 200;  // real views from cells that look good

// What a point on a wall sees, for asking whether a cell is in sight of it.
class Sight {
public:
    Sight(const Viewer& viewer, const Vec2d& eye) : viewer_(viewer), eye_(eye) {
        viewer.kernel().first_hits(eye, view_);
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
    const Wall& wall(const Span& s) const { return viewer_.walls()[at(s.wall)]; }

    const Viewer& viewer_;
    Vec2d eye_;
    View view_;
    std::vector<double> starts_;
    std::vector<std::size_t> order_;
};

struct Option {
    std::int64_t cell;
    int seen;     // sample points in sight
    bool domain;  // VF above the threshold
    float vf;
};

// The cells from which enough of a piece may be seen, the best first: inside the domain, with
// the greatest VF.
std::vector<Option> options_for(const CandidatePool& pool, std::int64_t piece) {
    const Viewer& viewer = pool.viewer();
    const Ground& ground = pool.ground();
    const Grid& grid = ground.grid;
    const Pieces& pieces = viewer.pieces();
    const Wall& wall = viewer.walls()[at(pieces.wall[at(piece)])];
    const Vec2d e = (wall.b - wall.a).normalized();
    const Vec2d normal =
        pieces.side[at(piece)] == left ? Vec2d(-e.y(), e.x()) : Vec2d(e.y(), -e.x());
    std::vector<Vec2d> points;
    std::vector<Sight> sights;
    Box box;
    for (int k = 0; k < samples; ++k) {
        const double s = pieces.s0_m[at(piece)] + pieces.length_m(piece) * (k + 0.5) / samples;
        points.push_back(wall.at(s) + off_the_wall_m * normal);
        sights.emplace_back(viewer, points.back());
        const Box reach = sights.back().reach(viewer.scanner().range_max_m);
        box.add(reach.min);
        box.add(reach.max);
    }
    const double needed = std::max(1.0, viewer.visible_fraction() * samples - 1);
    const Scanner& scanner = viewer.scanner();
    const double cos_limit = std::cos(scanner.max_incidence_deg * pi / 180) - 1e-9;
    const auto index = [&](double metres, std::int32_t count) {
        return static_cast<std::int32_t>(
            std::clamp(std::floor(metres / grid.cell_m), 0.0, static_cast<double>(count - 1)));
    };
    std::vector<Option> out;
    for (std::int32_t iy = index(box.min.y() - grid.origin.y(), grid.ny);
         iy <= index(box.max.y() - grid.origin.y(), grid.ny); ++iy) {
        for (std::int32_t ix = index(box.min.x() - grid.origin.x(), grid.nx);
             ix <= index(box.max.x() - grid.origin.x(), grid.nx); ++ix) {
            const std::int64_t cell = grid.id(ix, iy);
            if (std::isnan(ground.field[at(cell)])) continue;
            const Vec2d c = grid.centre(cell);
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
            out.push_back({cell, seen, ground.domain[at(cell)] != 0, ground.field[at(cell)]});
        }
    }
    std::sort(out.begin(), out.end(), [&](const Option& a, const Option& b) {
        return std::tuple(!a.domain, -a.vf, a.cell) < std::tuple(!b.domain, -b.vf, b.cell);
    });
    return out;
}

bool covers(const CoverageRow& row, std::int64_t piece) {
    return std::binary_search(row.begin(), row.end(), Seen{static_cast<std::int32_t>(piece), 0, 0},
                              [](const Seen& a, const Seen& b) { return a.piece < b.piece; });
}

// The first good cell, tried by real views; -1 when there is none.
std::int64_t best_cell(const CandidatePool& pool, std::int64_t piece) {
    std::vector<Option> options = options_for(pool, piece);
    // Cells that see every sample point are nearly certain; look at those first.
    std::stable_partition(options.begin(), options.end(),
                          [](const Option& o) { return o.seen == samples; });
    std::stable_partition(options.begin(), options.end(), [](const Option& o) { return o.domain; });
    for (std::size_t i = 0; i < std::min(options.size(), tests_most); ++i) {
        const std::int64_t cell = options[i].cell;
        if (covers(pool.viewer().row(pool.ground().grid.centre(cell)), piece)) return cell;
    }
    return -1;
}

}  // namespace

std::vector<PieceStatus> rescue_pieces(CandidatePool& pool, CandidateReport& report) {
    std::vector<std::uint8_t> covered = pool.covered();
    std::vector<std::int64_t> open;
    for (std::size_t p = 0; p < covered.size(); ++p) {
        if (covered[p] == 0) open.push_back(static_cast<std::int64_t>(p));
    }
    std::vector<std::int64_t> cell_of(open.size(), -1);
    pool.threads().for_each(static_cast<std::int64_t>(open.size()), 1,
                            [&](std::int64_t from, std::int64_t to) {
                                for (std::int64_t i = from; i < to; ++i) {
                                    cell_of[at(i)] = best_cell(pool, open[at(i)]);
                                }
                            });
    // One cell often serves many pieces: take cells in the order of pieces, skip what is covered
    // by then.
    std::vector<PieceStatus> reach(covered.size(), PieceStatus::covered);
    for (std::size_t i = 0; i < open.size(); ++i) {
        if (cell_of[i] < 0) {
            reach[at(open[i])] = PieceStatus::no_viewpoint;
            continue;
        }
        ++report.rescued_pieces;
        if (covered[at(open[i])] != 0) continue;
        pool.add({cell_of[i]}, CandidateKind::rescue);
        for (const Seen& s : pool.row_at(cell_of[i])) covered[at(s.piece)] = 1;
    }
    return reach;
}

}  // namespace vfplan
