#include "engine/tables/sight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "kernels/angle.h"

namespace vfplan {
namespace {

// What of a triangle lies in the band of a step around each row.
void add_triangle(const std::array<Vec2d, 3>& corner, double y_m, double step_m,
                  std::vector<Sight::Stretches>& rows) {
    const auto last = static_cast<double>(rows.size()) - 1;
    const auto [low, high] = std::minmax({corner[0].y(), corner[1].y(), corner[2].y()});
    const double from = std::max(std::floor((low - y_m) / step_m) - 1, 0.0);
    const double to = std::min(std::ceil((high - y_m) / step_m) + 1, last);
    for (double n = from; n <= to; ++n) {
        const double y0 = y_m + (n - 1) * step_m;
        const double y1 = y_m + (n + 1) * step_m;
        double x0 = std::numeric_limits<double>::infinity();
        double x1 = -x0;
        const auto add = [&](double x) {
            x0 = std::min(x0, x);
            x1 = std::max(x1, x);
        };
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec2d& a = corner[i];
            const Vec2d& b = corner[(i + 1) % 3];
            if (a.y() >= y0 && a.y() <= y1) add(a.x());
            for (const double y : {y0, y1}) {
                if ((a.y() < y) == (b.y() < y)) continue;
                add(a.x() + (b.x() - a.x()) * ((y - a.y()) / (b.y() - a.y())));
            }
        }
        if (x0 > x1) continue;
        x0 -= step_m;
        x1 += step_m;
        // Triangles come in the order of their angles, so most follow the one before.
        Sight::Stretches& row = rows[static_cast<std::size_t>(n)];
        if (!row.empty() && x0 <= row.back().second && x1 >= row.back().first) {
            row.back() = {std::min(x0, row.back().first), std::max(x1, row.back().second)};
        } else {
            row.emplace_back(x0, x1);
        }
    }
}

}  // namespace

Sight::Sight(const Scene& scene, const Vec2d& eye) : scene_(scene), eye_(eye) {
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

bool Sight::sees(const Vec2d& p) const {
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

void Sight::add_rows(double range_m, double y_m, double step_m,
                     std::vector<Stretches>& rows) const {
    // A wedge between two directions less than half a circle apart, up to the range at least.
    const auto wedge = [&](const Vec2d& from, const Vec2d& to) {
        const Vec2d a = from.normalized();
        const Vec2d b = to.normalized();
        const double far = range_m / std::sqrt(std::max(1e-3, (1 + a.dot(b)) / 2));
        add_triangle({eye_, eye_ + far * a, eye_ + far * b}, y_m, step_m, rows);
    };
    const auto open = [&](const Vec2d& from, const Vec2d& to, double angle) {
        constexpr double widest = pi / 3;
        const double parts = std::ceil(angle / widest);
        Vec2d before = from.normalized();
        for (double k = 1; k <= parts; ++k) {
            const double turn = angle / parts;
            const Vec2d next =
                k == parts ? to
                           : Vec2d(before.x() * std::cos(turn) - before.y() * std::sin(turn),
                                   before.x() * std::sin(turn) + before.y() * std::cos(turn));
            wedge(before, next);
            before = next;
        }
    };
    if (view_.empty()) {
        open({1, 0}, {1, 0}, 2 * pi);
        return;
    }
    for (std::size_t n = 0; n < order_.size(); ++n) {
        const Span& s = view_[order_[n]];
        const Span& next = view_[order_[(n + 1) % order_.size()]];
        const Vec2d begin = wall(s).at(s.s_begin_m);
        const Vec2d end = wall(s).at(s.s_end_m);
        add_triangle({eye_, begin, end}, y_m, step_m, rows);
        const Vec2d from = end - eye_;
        const Vec2d to = wall(next).at(next.s_begin_m) - eye_;
        double gap = angle_between_rad(from, to);
        if (cross(from, to) < 0) gap = gap < 1e-3 ? 0 : 2 * pi - gap;  // spans may overlap a little
        constexpr double nothing = 1e-9;
        if (gap > nothing) open(from, to, gap);
    }
}

Box Sight::reach(double range_m) const {
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

}  // namespace vfplan
