#include "engine/job/outlook.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernels/angle.h"
#include "kernels/exact_scene.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int64_t views = 16;
constexpr std::size_t walls_most = 4000;
constexpr double before_wall_m = 0.1;

double free_length_m(const Wall& w) {
    return (w.free_side[left] + w.free_side[right]) * w.length_m();
}

// Walls around a place, as far as the range or until there are enough of them.
std::vector<Wall> walls_near(const Site& site, const Vec2d& eye, double& reach_m) {
    for (;; reach_m /= 2) {
        std::vector<Wall> near;
        const Vec2d reach(reach_m, reach_m);
        const Vec2d from = eye - reach;
        const Vec2d to = eye + reach;
        for (const Wall& w : site.walls) {
            if (std::max(w.a.x(), w.b.x()) < from.x() || std::min(w.a.x(), w.b.x()) > to.x() ||
                std::max(w.a.y(), w.b.y()) < from.y() || std::min(w.a.y(), w.b.y()) > to.y()) {
                continue;
            }
            near.push_back(w);
            near.back().a -= eye;
            near.back().b -= eye;
        }
        if (near.size() <= walls_most || reach_m < 2 * before_wall_m) return near;
    }
}

Outlook look_from(const Site& site, const Wall& wall, double range_m) {
    const Side side = wall.free_side[left] ? left : right;
    const Vec2d e = (wall.b - wall.a).normalized();
    const Vec2d normal = side == left ? Vec2d(-e.y(), e.x()) : Vec2d(e.y(), -e.x());
    const Vec2d eye = (wall.a + wall.b) / 2 + before_wall_m * normal;
    double reach_m = range_m;
    const std::vector<Wall> near = walls_near(site, eye, reach_m);
    const Vec2d around(1, 1);
    const ExactScene scene(near, {-around, around}, reach_m);
    View hits;
    scene.first_hits({0, 0}, hits);
    double seen_rad = 0;
    double sum = 0;
    Outlook out;
    for (const Span& s : hits) {
        const Wall& w = near[idx(s.wall)];
        const double far = w.at((s.s_begin_m + s.s_end_m) / 2).norm();
        if (far < 2 * before_wall_m) continue;  // what it stands before
        const double angle = angle_between_rad(w.at(s.s_begin_m), w.at(s.s_end_m));
        seen_rad += angle;
        sum += angle * std::min(far, reach_m);
        ++out.spans;
    }
    const double open_rad = std::max(0.0, pi - seen_rad);  // half the world is before a wall
    out.sight_m = (sum + open_rad * reach_m) / std::max(seen_rad + open_rad, 1e-9);
    return out;
}

}  // namespace

Outlook look_around(const Site& site, double range_m, const Threads& threads) {
    double whole = 0;
    for (const Wall& w : site.walls) whole += free_length_m(w);
    std::vector<const Wall*> from;
    double before = 0;
    for (const Wall& w : site.walls) {
        const double here = free_length_m(w);
        if (here <= 0) continue;
        before += here;
        // A long wall is looked from once.
        if (before < whole * (static_cast<double>(from.size()) + 0.5) / views) continue;
        from.push_back(&w);
    }
    if (from.empty()) return {range_m, 1};
    std::vector<Outlook> each(from.size());
    threads.for_each(static_cast<std::int64_t>(from.size()), 1,
                     [&](std::int64_t begin, std::int64_t end) {
                         for (std::int64_t i = begin; i < end; ++i) {
                             each[idx(i)] = look_from(site, *from[idx(i)], range_m);
                         }
                     });
    Outlook out;
    for (const Outlook& o : each) {
        out.sight_m += o.sight_m / static_cast<double>(each.size());
        out.spans += o.spans / static_cast<double>(each.size());
    }
    return out;
}

}  // namespace vfplan
