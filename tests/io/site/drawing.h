// A site as it was drawn, and how well walls agree with it. Whether a point is solid is counted
// from the rings, unrounded, and a face is looked for a few millimetres beside it: nothing is
// shared with the reader.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "io/features/feature.h"
#include "kernels/wall.h"

namespace vfplan::test {

inline constexpr double tolerance_m = 0.0015;  // walls lie this near to what was drawn
inline constexpr double beside_m = 0.003;      // faces are looked at from here
inline constexpr double clear_m = 0.002;       // nearer to something else nobody can tell
inline constexpr double step_m = 0.005;
inline constexpr double most_wrong_m = 0.02;

struct Edge {
    Vec2d a;
    Vec2d b;
    double distance(const Vec2d& p) const {
        const Vec2d e = b - a;
        const double n = e.squaredNorm();
        const double t = n > 0 ? std::clamp((p - a).dot(e) / n, 0.0, 1.0) : 0.0;
        return (a + t * e - p).norm();
    }
};

// The drawing, and what can be said of a point from it alone.
class Drawing {
public:
    explicit Drawing(const FeatureSet& set) {
        for (const Feature& f : set.features) {
            const bool room = f.role == Role::room || f.role == Role::outline;
            for (const Polygon& p : f.polygons) {
                if (!room) solids_.push_back(p);
                if (f.role == Role::room) continue;
                add(p.outer, true, f.role);
                for (const Ring& hole : p.holes) add(hole, true, f.role);
            }
            for (const Line& line : f.lines) {
                if (f.role != Role::door) add(line, false, f.role);
            }
        }
    }
    const std::vector<Edge>& edges() const { return edges_; }
    bool is_line(std::size_t edge) const { return line_[edge]; }
    Role role(std::size_t edge) const { return role_[edge]; }
    bool solid(const Vec2d& p) const { return inside(solids_, p); }
    double clearance(const Vec2d& p) const {
        double out = 1e9;
        for (const Edge& e : edges_) out = std::min(out, e.distance(p));
        return out;
    }
    bool sees(const Vec2d& p, const Vec2d& q) const {
        return std::none_of(edges_.begin(), edges_.end(), [&](const Edge& e) {
            return orient(e.a, e.b, p) * orient(e.a, e.b, q) <= 0 &&
                   orient(p, q, e.a) * orient(p, q, e.b) <= 0;
        });
    }

private:
    void add(const std::vector<Vec2d>& points, bool closed, Role role) {
        for (std::size_t i = closed ? 0 : 1; i < points.size(); ++i) {
            edges_.push_back({i == 0 ? points.back() : points[i - 1], points[i]});
            line_.push_back(!closed);
            role_.push_back(role);
        }
    }
    static bool odd(const Ring& ring, const Vec2d& p) {
        bool in = false;
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2d& a = ring[i];
            const Vec2d& b = ring[(i + 1) % ring.size()];
            if ((a.y() > p.y()) == (b.y() > p.y())) continue;
            if ((orient(a, b, p) > 0) == (b.y() > a.y())) in = !in;
        }
        return in;
    }
    static bool inside(const std::vector<Polygon>& polygons, const Vec2d& p) {
        return std::any_of(polygons.begin(), polygons.end(), [&](const Polygon& polygon) {
            bool in = odd(polygon.outer, p);
            for (const Ring& hole : polygon.holes) in = in != odd(hole, p);
            return in;
        });
    }
    std::vector<Edge> edges_;
    std::vector<bool> line_;
    std::vector<Role> role_;
    std::vector<Polygon> solids_;
};

// Length of what goes wrong along an edge, in unbroken runs.
class Run {
public:
    void add(bool wrong) {
        now_ = wrong ? now_ + step_m : 0;
        longest_ = std::max(longest_, now_);
    }
    double longest_m() const { return longest_; }

private:
    double now_ = 0;
    double longest_ = 0;
};

template <class F>
void along(const Vec2d& a, const Vec2d& b, F&& f) {
    const double length = (b - a).norm();
    if (length < step_m) return;
    const Vec2d e = (b - a) / length;
    const Vec2d to_left(-e.y(), e.x());
    for (double s = step_m / 2; s < length; s += step_m) f(Vec2d(a + s * e), to_left);
}

// Whether a wall with a free face towards `side` lies at p.
inline bool has_face(const Site& site, const Vec2d& p, const Vec2d& side) {
    return std::any_of(site.walls.begin(), site.walls.end(), [&](const Wall& w) {
        if (Edge{w.a, w.b}.distance(p) > tolerance_m) return false;
        return w.free_side[cross(w.b - w.a, side) > 0 ? left : right];
    });
}

// Where a segment is crossed by walls, from its start.
inline std::vector<double> crossed_by(const std::vector<Edge>& edges, const Vec2d& from,
                                      const Vec2d& to) {
    std::vector<double> at;
    for (const Edge& e : edges) {
        const double u = orient(e.a, e.b, from);
        const double v = orient(e.a, e.b, to);
        if (u * v > 0 || orient(from, to, e.a) * orient(from, to, e.b) > 0 || u == v) continue;
        at.push_back((to - from).norm() * u / (u - v));
    }
    std::sort(at.begin(), at.end());
    return at;
}

// A slit before p that the drawing need not have: snapping may keep one of a few millimetres or
// close it, and open one of a single snap where walls overlapped by less.
inline bool slit_at(const Drawing& drawn, const std::vector<Edge>& walls, const Vec2d& p,
                    const Vec2d& normal) {
    const Vec2d from = p - beside_m * normal;
    const std::vector<double> at = crossed_by(drawn.edges(), from, p + beside_m * normal);
    for (std::size_t i = 1; i < at.size(); ++i) {
        if (at[i] - at[i - 1] < 1e-5) continue;
        if (!drawn.solid(from + (at[i] + at[i - 1]) / 2 * normal)) return true;
    }
    return !crossed_by(walls, p + 1e-7 * normal, p + tolerance_m * normal).empty();
}

// No face of ours is inside a solid or where nothing was drawn; outdoors none is shut that is not.
inline double worst_invented_m(const Site& site, const Drawing& drawn, bool outdoor) {
    double worst = 0;
    std::vector<Edge> walls;
    for (const Wall& w : site.walls) walls.push_back({w.a, w.b});
    for (const Wall& w : site.walls) {
        Run off;
        along(w.a, w.b,
              [&](const Vec2d& p, const Vec2d&) { off.add(drawn.clearance(p) > tolerance_m); });
        worst = std::max(worst, off.longest_m());
        for (const Side side : {left, right}) {
            Run run;
            along(w.a, w.b, [&](const Vec2d& p, const Vec2d& to_left) {
                const Vec2d normal = side == left ? to_left : Vec2d(-to_left);
                const Vec2d q = p + beside_m * normal;
                const bool known = drawn.clearance(q) > clear_m;
                const bool wrong = w.free_side[side]
                                       ? drawn.solid(q) && !slit_at(drawn, walls, p, normal)
                                       : outdoor && !drawn.solid(q);
                run.add(known && wrong);
            });
            worst = std::max(worst, run.longest_m());
        }
    }
    return worst;
}

// Faces of the drawing that are not ours, of those that `counts` for a place before them.
template <class Counts>
double worst_lost_m(const Site& site, const Drawing& drawn, Counts&& counts) {
    double worst = 0;
    for (std::size_t e = 0; e < drawn.edges().size(); ++e) {
        const Edge& edge = drawn.edges()[e];
        for (const double sign : {1.0, -1.0}) {
            Run run;
            along(edge.a, edge.b, [&](const Vec2d& p, const Vec2d& to_left) {
                const Vec2d side = sign * to_left;
                const Vec2d q = p + beside_m * side;
                const Vec2d behind = p - beside_m * side;
                bool wrong = !drawn.solid(q) && drawn.clearance(q) > clear_m &&
                             drawn.clearance(behind) > clear_m;
                // Of a solid only what has it behind is a face, and nothing solid right before it.
                if (!drawn.is_line(e) && drawn.role(e) != Role::outline) {
                    wrong = wrong && drawn.solid(behind) && !drawn.solid(p + 1e-7 * side);
                }
                run.add(wrong && !has_face(site, p, side) && counts(q));
            });
            worst = std::max(worst, run.longest_m());
        }
    }
    return worst;
}

}  // namespace vfplan::test
