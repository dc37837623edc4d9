#include "engine/tables/best_cell.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

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

    // Less good than b: best are those inside the domain, with the greatest VF.
    bool operator<(const Option& b) const {
        return std::tuple(domain, vf, -cell) < std::tuple(b.domain, b.vf, -b.cell);
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

}  // namespace

BestCell best_cell(const TableJob& job, const Scene& scene, const FieldWindow& field,
                   double threshold_rad, std::int32_t piece) {
    const PieceInSight in_sight(job, scene, piece);
    const Grid& grid = job.layout().grid;
    std::size_t tests = 0;
    BestCell out;
    const auto covers_it = [&](std::int64_t cell) {
        ++tests;
        CoverageRow row = job.scenes.look(grid.centre(cell)).row;
        if (!covers(row, scene.site_piece(piece))) return false;
        out = {cell, std::move(row)};
        return true;
    };
    // Most cells are never asked whether they see the piece: a heap gives the best one by one.
    std::vector<Option> open = in_sight.options(field, threshold_rad);
    std::make_heap(open.begin(), open.end());
    std::vector<std::int64_t> partly;
    const auto one_of_partly = [&] {
        for (const std::int64_t cell : std::exchange(partly, {})) {
            if (tests >= tests_most) break;
            if (covers_it(cell)) return true;
        }
        return false;
    };
    bool domain = true;
    while (!open.empty() && tests < tests_most) {
        std::pop_heap(open.begin(), open.end());
        const Option o = open.back();
        open.pop_back();
        if (domain && !o.domain) {
            domain = false;
            if (one_of_partly() || tests >= tests_most) return out;
        }
        const int seen = in_sight.seen_from(grid.centre(o.cell) - scene.origin());
        if (seen == 0) continue;
        if (seen < samples) {
            partly.push_back(o.cell);
        } else if (covers_it(o.cell)) {
            return out;
        }
    }
    one_of_partly();
    return out;
}

}  // namespace vfplan
