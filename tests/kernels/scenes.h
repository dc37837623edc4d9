// Hand-made walls for the kernels' tests, and the slow, obvious way to see them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "kernels/angle.h"
#include "kernels/embree_scene.h"
#include "kernels/exact_scene.h"
#include "kernels/view.h"

namespace vfplan::test {

inline Wall wall(const Vec2d& a, const Vec2d& b) {
    Wall w;
    w.a = a;
    w.b = b;
    return w;
}

// Counter-clockwise rings have their left sides inside.
inline void add_ring(std::vector<Wall>& walls, const Ring& ring) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        walls.push_back(wall(ring[i], ring[(i + 1) % ring.size()]));
    }
}

inline std::vector<Wall> rectangle(const Vec2d& lo, const Vec2d& hi) {
    std::vector<Wall> walls;
    add_ring(walls, {lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}});
    return walls;
}

inline Box bounds_of(const std::vector<Wall>& walls) {
    Box box;
    for (const Wall& w : walls) {
        box.add(w.a);
        box.add(w.b);
    }
    return box;
}

// n x n cells of 10 m with one turned square in each; squares never touch.
inline std::vector<Wall> scattered_squares(int n, std::mt19937_64& random) {
    std::uniform_real_distribution<double> radius(1.5, 4.5);
    std::uniform_real_distribution<double> turn(0, pi / 2);
    std::vector<Wall> walls;
    for (int iy = 0; iy < n; ++iy) {
        for (int ix = 0; ix < n; ++ix) {
            const Vec2d centre(10 * ix + 5, 10 * iy + 5);
            const double r = radius(random);
            const double t = turn(random);
            Ring ring;
            for (int k = 0; k < 4; ++k) {
                const double angle = t + k * pi / 2;
                ring.push_back(centre + r * Vec2d(std::cos(angle), std::sin(angle)));
            }
            add_ring(walls, ring);
        }
    }
    return walls;
}

// Metres along a unit direction to a wall; infinite where it is missed.
inline double metres_to(const Wall& w, const Vec2d& eye, const Vec2d& direction) {
    const Vec2d e = w.b - w.a;
    const double den = cross(direction, e);
    if (den == 0) return std::numeric_limits<double>::infinity();
    const double u = cross(w.a - eye, direction) / den;
    const double t = cross(w.a - eye, e) / den;
    return u >= 0 && u <= 1 && t > 0 ? t : std::numeric_limits<double>::infinity();
}

struct Hit {
    std::int32_t wall = -1;
    double distance_m = std::numeric_limits<double>::infinity();
};

inline Hit first_hit(const std::vector<Wall>& walls, const Vec2d& eye, const Vec2d& direction) {
    Hit hit;
    for (std::size_t i = 0; i < walls.size(); ++i) {
        const double d = metres_to(walls[i], eye, direction);
        if (d < hit.distance_m) hit = {static_cast<std::int32_t>(i), d};
    }
    return hit;
}

// True where eye stands within a counter-clockwise square of scattered_squares().
inline bool inside_a_square(const std::vector<Wall>& walls, const Vec2d& eye) {
    for (std::size_t i = 0; i + 3 < walls.size(); i += 4) {
        bool inside = true;
        for (std::size_t k = 0; k < 4; ++k) {
            inside = inside && orient(walls[i + k].a, walls[i + k].b, eye) >= -1e-9;
        }
        if (inside) return true;
    }
    return false;
}

inline Vec2d random_eye(const std::vector<Wall>& squares, const Box& box, std::mt19937_64& random) {
    std::uniform_real_distribution<double> x(box.min.x(), box.max.x());
    std::uniform_real_distribution<double> y(box.min.y(), box.max.y());
    while (true) {
        const Vec2d eye(x(random), y(random));
        if (!inside_a_square(squares, eye)) return eye;
    }
}

inline std::unique_ptr<ViewKernel> kernel_named(const std::string& name,
                                                const std::vector<Wall>& walls, const Box& around,
                                                double reach_m, int rays = 4096) {
    if (name == "exact") return std::make_unique<ExactScene>(walls, around, reach_m);
    return std::make_unique<EmbreeScene>(walls, around, reach_m, rays);
}

inline View look(const ViewKernel& kernel, const std::vector<Wall>& walls, const Scanner& scanner,
                 const Vec2d& eye) {
    View hits;
    View out;
    kernel.first_hits(eye, hits);
    observe(walls, scanner, eye, hits, out);
    return out;
}

}  // namespace vfplan::test
