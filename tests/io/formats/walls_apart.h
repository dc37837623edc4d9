// How far the walls of two sites lie apart, by brute force.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/io/site/features.h"

namespace vfplan::test {

struct Apart {
    double farthest_m = 0;  // of a place on a wall from the nearest wall of the other site
    Vec2d at{0, 0};         // there
    std::vector<Vec2d> wrong_at;
    double length_m[2] = {0, 0};
    double wrong_m = 0;  // length of walls that lie more than 5 cm from the other's
    double slits_m = 0;  // of those that face nothing but a slit of less than 5 cm, left out

    std::string text() const {
        return fmt::format(
            "{:.3f} m apart at ({:.2f}, {:.2f}), {:.2f} m of {:.2f} and {:.2f} m; {:.2f} m in "
            "slits",
            farthest_m, at.x(), at.y(), wrong_m, length_m[0], length_m[1], slits_m);
    }
};

// Walls by squares of a metre.
class WallsNear {
public:
    explicit WallsNear(const Site& site, const Vec2d& move = {0, 0}) {
        for (const Wall& w : site.walls) {
            const Vec2d a = w.a + site.origin + move;
            const Vec2d b = w.b + site.origin + move;
            const auto i = walls_.size();
            walls_.emplace_back(a, b);
            const double n = std::ceil((b - a).norm() / 0.5);
            for (double k = 0; k <= n; ++k) {
                const Vec2d p = a + (b - a) * (n > 0 ? k / n : 0);
                auto& list = at_[{std::floor(p.x()), std::floor(p.y())}];
                if (list.empty() || list.back() != i) list.push_back(i);
            }
        }
    }
    // At most 1 m.
    double distance(const Vec2d& p) const {
        double out = 1;
        for (double x = -1; x <= 1; ++x) {
            for (double y = -1; y <= 1; ++y) {
                const auto found = at_.find({std::floor(p.x()) + x, std::floor(p.y()) + y});
                if (found == at_.end()) continue;
                for (const std::size_t i : found->second) {
                    const auto& [a, b] = walls_[i];
                    const Vec2d e = b - a;
                    const double t = std::clamp((p - a).dot(e) / e.squaredNorm(), 0.0, 1.0);
                    out = std::min(out, (a + t * e - p).norm());
                }
            }
        }
        return out;
    }

private:
    std::vector<std::pair<Vec2d, Vec2d>> walls_;
    std::map<std::pair<double, double>, std::vector<std::size_t>> at_;
};

// Both ways; `move` brings the places of `a` to those of `b`.
inline Apart apart(const Site& a, const Site& b, const Vec2d& move) {
    constexpr double step_m = 0.01;
    constexpr double slit_m = 0.025;
    const WallsNear from(a, move);
    const WallsNear to(b);
    Apart out;
    const auto look = [&](const Site& site, const Vec2d& by, const WallsNear& there,
                          double& length) {
        for (const Wall& w : site.walls) {
            length += w.length_m();
            const Vec2d u = (w.b - w.a) / w.length_m();
            const Vec2d to_left = slit_m * Vec2d(-u.y(), u.x());
            const double n = std::ceil(w.length_m() / step_m);
            for (double k = 0; k <= n; ++k) {
                const Vec2d p = site.origin + w.a + (w.b - w.a) * (k / n);
                const double d = there.distance(p + by);
                if (d <= 0.05) continue;
                if (!is_free(site, p + to_left) && !is_free(site, p - to_left)) {
                    out.slits_m += w.length_m() / (n + 1);
                    continue;
                }
                out.wrong_m += w.length_m() / (n + 1);
                out.wrong_at.push_back(p + by);
                if (d > out.farthest_m) {
                    out.farthest_m = d;
                    out.at = p + by;
                }
            }
        }
    };
    look(a, move, to, out.length_m[0]);
    look(b, {0, 0}, from, out.length_m[1]);
    return out;
}

}  // namespace vfplan::test
