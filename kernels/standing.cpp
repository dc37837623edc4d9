#include "kernels/standing.h"

#include <algorithm>
#include <cmath>

#include "kernels/free_cells.h"

namespace vfplan {
namespace {

Vec2d nearest_on(const Vec2d& a, const Vec2d& b, const Vec2d& p) {
    const Vec2d e = b - a;
    const double n = e.squaredNorm();
    return n > 0 ? Vec2d(a + std::clamp((p - a).dot(e) / n, 0.0, 1.0) * e) : a;
}

}  // namespace

Standing::Standing(const Site& site, std::vector<Border> forbidden)
    : site_(site), forbidden_(std::move(forbidden)) {}

std::string_view Standing::objection(const Vec2d& at) const {
    const auto touches = [&](const Wall& w) {
        return (nearest_on(w.a, w.b, at) - at).norm() < at_wall_m;
    };
    if (!site_.extent.contains(at)) return "it is outside the site";
    if (std::any_of(site_.walls.begin(), site_.walls.end(), touches)) return "it is on a wall";
    if (!inside_odd(site_.free_border, at)) return "it is not in free space";
    if (inside_odd(forbidden_, at)) return "plan.forbidden covers it";
    return {};
}

std::optional<Vec2d> Standing::nearest(const Vec2d& at) const {
    constexpr double beside_m = 0.01;
    constexpr std::size_t most_tries = 300;
    const Vec2d lo = site_.extent.min + Vec2d(beside_m, beside_m);
    const Vec2d hi = site_.extent.max - Vec2d(beside_m, beside_m);
    const Vec2d within = at.cwiseMax(lo).cwiseMin(hi);
    std::vector<Vec2d> tries = {within};
    const auto add = [&](const Vec2d& a, const Vec2d& b) {
        const Vec2d foot = nearest_on(a, b, within);
        const Vec2d e = (b - a).normalized();
        for (const double side : {beside_m, -beside_m}) {
            const Vec2d p = foot + side * Vec2d(-e.y(), e.x());
            tries.emplace_back(std::round(p.x() * 1000) / 1000, std::round(p.y() * 1000) / 1000);
        }
    };
    for (const Wall& w : site_.walls) add(w.a, w.b);
    for (const Border& b : site_.free_border) add(b.a, b.b);
    for (const Border& b : forbidden_) add(b.a, b.b);
    const std::size_t n = std::min(most_tries, tries.size());
    std::partial_sort(tries.begin(), tries.begin() + static_cast<std::ptrdiff_t>(n), tries.end(),
                      [&](const Vec2d& p, const Vec2d& q) {
                          return (p - at).squaredNorm() < (q - at).squaredNorm();
                      });
    tries.resize(n);
    const auto good = std::find_if(tries.begin(), tries.end(),
                                   [&](const Vec2d& p) { return objection(p).empty(); });
    return good == tries.end() ? std::nullopt : std::optional(*good);
}

}  // namespace vfplan
