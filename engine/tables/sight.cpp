#include "engine/tables/sight.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "kernels/angle.h"

namespace vfplan {

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
