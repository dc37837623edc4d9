#include "kernels/view.h"

#include <algorithm>
#include <cmath>

#include "kernels/angle.h"
#include "kernels/shadow.h"

namespace vfplan {
namespace {

// Where the eye stands to a wall: foot of the perpendicular and distance to the line.
struct Foot {
    double s_m = 0;
    double distance_m = 0;
};

Foot foot_on(const Wall& wall, const Vec2d& eye) {
    const Vec2d e = wall.b - wall.a;
    const double length = wall.length_m();
    const Vec2d to_eye = eye - wall.a;
    return {to_eye.dot(e) / length, std::abs(cross(e, to_eye)) / length};
}

// Half-widths around the foot between which the scanner observes; empty when outer <= inner.
struct Reach {
    double inner_m = 0;
    double outer_m = -1;
};

Reach reach_on(const Scanner& scanner, double tan_incidence, double distance_m) {
    const double h2 = distance_m * distance_m;
    const double max2 = scanner.range_max_m * scanner.range_max_m;
    const double min2 = scanner.range_min_m * scanner.range_min_m;
    if (h2 >= max2) return {};
    Reach reach;
    reach.outer_m = std::sqrt(max2 - h2);
    const double tan_steepest = tan_incidence >= 0 ? tan_incidence : 1 / edge_on_rad;
    reach.outer_m = std::min(reach.outer_m, distance_m * tan_steepest);
    if (h2 < min2) reach.inner_m = std::sqrt(min2 - h2);
    return reach;
}

// The parts of [lo, hi], in metres along a wall, that the scanner observes: keep(from, to, angle)
// for none, one or two, counter-clockwise around the eye.
template <class Keep>
void observed_parts(const Wall& wall, Side side, const Scanner& scanner, double tan_limit,
                    const Vec2d& eye, double lo, double hi, const Keep& keep) {
    const Foot foot = foot_on(wall, eye);
    const Reach reach = reach_on(scanner, tan_limit, foot.distance_m);
    if (reach.outer_m <= reach.inner_m) return;
    const auto part = [&](double from, double to) {
        from = std::max(from, lo);
        to = std::min(to, hi);
        if (!(to > from)) return;
        keep(from, to,
             angle_upper_rad(
                 foot.distance_m * (to - from),
                 foot.distance_m * foot.distance_m + (from - foot.s_m) * (to - foot.s_m)));
    };
    const double near_from = foot.s_m - reach.outer_m;
    const double near_to = foot.s_m - reach.inner_m;
    const double far_from = foot.s_m + reach.inner_m;
    const double far_to = foot.s_m + reach.outer_m;
    if (reach.inner_m <= 0) {
        part(near_from, far_to);
    } else if (side == left) {
        part(near_from, near_to);
        part(far_from, far_to);
    } else {
        part(far_from, far_to);
        part(near_from, near_to);
    }
}

}  // namespace

double tan_incidence(const Scanner& scanner) {
    if (scanner.max_incidence_deg >= 90) return -1;
    // x87 tangent: the same on every processor, unlike the double one.
    return static_cast<double>(std::tan(static_cast<long double>(scanner.max_incidence_deg) *
                                        3.14159265358979323846L / 180));
}

double observed_angle_rad(const Wall& wall, const Scanner& scanner, double tan_limit,
                          const Vec2d& eye, const Vec2d& from, const Vec2d& to) {
    const double length = wall.length_m();
    const double s = shadow_m(wall, length, eye, from);
    const double t = shadow_m(wall, length, eye, to);
    const Side side = orient(wall.a, wall.b, eye) >= 0 ? left : right;
    double sum = 0;
    observed_parts(wall, side, scanner, tan_limit, eye, std::min(s, t), std::max(s, t),
                   [&](double, double, double angle_rad) { sum += angle_rad; });
    return sum;
}

void observe(const std::vector<Wall>& walls, const Scanner& scanner, const Vec2d& eye,
             const View& first_hits, View& out) {
    out.clear();
    const double tan_limit = tan_incidence(scanner);
    for (const Span& hit : first_hits) {
        const Wall& wall = walls[static_cast<std::size_t>(hit.wall)];
        if (!wall.scanned) continue;
        observed_parts(wall, hit.side, scanner, tan_limit, eye,
                       std::min(hit.s_begin_m, hit.s_end_m), std::max(hit.s_begin_m, hit.s_end_m),
                       [&](double from, double to, double angle_rad) {
                           const bool forward = hit.side == left;
                           out.push_back({hit.wall, hit.side, forward ? from : to,
                                          forward ? to : from, angle_rad});
                       });
    }
    if (out.size() < 2) return;
    std::size_t first = 0;
    double smallest = 5;
    for (std::size_t i = 0; i < out.size(); ++i) {
        const Wall& wall = walls[static_cast<std::size_t>(out[i].wall)];
        const double p = pseudo_angle(wall.at(out[i].s_begin_m) - eye);
        if (p < smallest) {
            smallest = p;
            first = i;
        }
    }
    std::rotate(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(first), out.end());
}

double view_angle_rad(const View& observed) {
    double sum = 0;
    for (const Span& span : observed) sum += span.angle_rad;
    return sum;
}

}  // namespace vfplan
