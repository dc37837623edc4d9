#include "kernels/weak_view.h"

#include <algorithm>
#include <array>

#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr double tolerance_m = 1e-7;  // so much too far everything reaches, for rounding
constexpr int steps_most = 200'000;

// A convex polygon with few corners.
struct Polygon8 {
    std::array<Vec2d, 8> at;
    std::size_t size = 0;

    void add(const Vec2d& p) {
        if (size < at.size()) at[size++] = p;
    }
};

// What lies left of from -> to; everything where the two are one.
struct HalfPlane {
    Vec2d from;
    Vec2d normal{0, 0};

    HalfPlane(const Vec2d& a, const Vec2d& b) : from(a) {
        const Vec2d d = b - a;
        const double length = d.norm();
        if (length > 1e-6) normal = Vec2d(-d.y(), d.x()) / length;
    }
    double inside(const Vec2d& p) const { return (p - from).dot(normal) + tolerance_m; }
};

void clip(Polygon8& polygon, const HalfPlane& by) {
    Polygon8 out;
    for (std::size_t i = 0; i < polygon.size; ++i) {
        const Vec2d& a = polygon.at[i];
        const Vec2d& b = polygon.at[(i + 1) % polygon.size];
        const double in_a = by.inside(a);
        const double in_b = by.inside(b);
        if (in_a >= 0) out.add(a);
        if ((in_a >= 0) != (in_b >= 0)) out.add(a + (b - a) * (in_a / (in_a - in_b)));
    }
    polygon = out;
}

struct Segment {
    Vec2d a;
    Vec2d b;
};

// False when nothing is left.
bool clip(Segment& s, const HalfPlane& by) {
    const double in_a = by.inside(s.a);
    const double in_b = by.inside(s.b);
    if (in_a < 0 && in_b < 0) return false;
    if (in_a < 0) {
        s.a = s.a + (s.b - s.a) * (in_a / (in_a - in_b));
    } else if (in_b < 0) {
        s.b = s.a + (s.b - s.a) * (in_a / (in_a - in_b));
    }
    return true;
}

double distance(const Vec2d& p, const Segment& s) {
    const Vec2d e = s.b - s.a;
    const double n = e.squaredNorm();
    const double t = n > 0 ? std::clamp((p - s.a).dot(e) / n, 0.0, 1.0) : 0.0;
    return (s.a + t * e - p).norm();
}

// Into a triangle through a window in its edge. Seen along the way the stretch runs from left to
// right, the window too.
struct Step {
    std::int32_t triangle = -1;
    std::size_t edge = 0;
    Segment stretch;
    Segment window;
};

}  // namespace

WeakView::WeakView(const std::vector<Wall>& walls, const Box& around)
    : walls_(walls), mesh_(triangulate(walls, around, 10 + around.size().norm())) {
    faces_.resize(2 * walls_.size());
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        const Triangle& triangle = mesh_.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle.wall[i] < 0) continue;
            const Wall& w = walls_[idx(triangle.wall[i])];
            const Side side = corner(triangle, i + 1) == w.a ? left : right;
            faces_[2 * idx(triangle.wall[i]) + side] = {static_cast<std::int32_t>(t), i};
        }
    }
    space_.assign(mesh_.triangles.size(), -1);
    std::vector<std::int32_t> open;
    for (std::size_t first = 0; first < space_.size(); ++first) {
        if (space_[first] >= 0) continue;
        space_[first] = spaces_;
        open.push_back(static_cast<std::int32_t>(first));
        while (!open.empty()) {
            const Triangle& t = mesh_.triangles[idx(open.back())];
            open.pop_back();
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int32_t next = t.neighbour[i];
                if (t.wall[i] >= 0 || next < 0 || space_[idx(next)] >= 0) continue;
                space_[idx(next)] = spaces_;
                open.push_back(next);
            }
        }
        ++spaces_;
    }
}

std::int32_t WeakView::space(std::int32_t wall, Side side) const {
    const Face& f = face(wall, side);
    return f.triangle < 0 ? -1 : space_[idx(f.triangle)];
}

bool WeakView::parts(std::int32_t wall, Side side, double s0_m, double s1_m, double reach_m,
                     const std::function<void(std::span<const Vec2d>)>& part) const {
    const Face& start = face(wall, side);
    if (start.triangle < 0) return true;
    // As it runs with the free side to its left, it begins on the left of who looks from it.
    const Wall& w = walls_[idx(wall)];
    const Segment stretch =
        side == left ? Segment{w.at(s0_m), w.at(s1_m)} : Segment{w.at(s1_m), w.at(s0_m)};
    const Vec2d middle = (stretch.a + stretch.b) / 2;
    const double far_m = reach_m + (stretch.b - stretch.a).norm() / 2 + tolerance_m;
    const HalfPlane before = side == left ? HalfPlane(w.a, w.b) : HalfPlane(w.b, w.a);

    std::vector<Step> open;
    // Through edge `i` of a triangle, as far as `window` in it is open.
    const auto through = [&](const Triangle& t, std::size_t i, Segment window, Segment from) {
        if (t.wall[i] >= 0 || t.neighbour[i] < 0) return;
        if (!clip(window, before) || distance(middle, window) > far_m) return;
        // Only what lies on this side of the edge sees through it.
        if (!clip(from, HalfPlane(corner(t, i + 1), corner(t, i + 2)))) return;
        const Triangle& next = mesh_.triangles[idx(t.neighbour[i])];
        std::size_t edge = 0;
        while (edge < 2 &&
               next.neighbour[edge] != static_cast<std::int32_t>(&t - mesh_.triangles.data())) {
            ++edge;
        }
        open.push_back({t.neighbour[i], edge, from, window});
    };
    const Triangle& first = mesh_.triangles[idx(start.triangle)];
    part(std::array{corner(first, 0), corner(first, 1), corner(first, 2)});
    for (std::size_t k = 1; k < 3; ++k) {
        const std::size_t i = (start.edge + k) % 3;
        through(first, i, {corner(first, i + 2), corner(first, i + 1)}, stretch);
    }
    int steps = 0;
    while (!open.empty()) {
        if (++steps > steps_most) return false;
        const Step s = open.back();
        open.pop_back();
        const Triangle& t = mesh_.triangles[idx(s.triangle)];
        // Beyond a window sight is bounded by the lines from either end of the stretch over the
        // window's other end.
        const HalfPlane right_of(s.window.a, s.stretch.b);
        const HalfPlane left_of(s.stretch.a, s.window.b);
        Polygon8 seen;
        for (std::size_t i = 0; i < 3; ++i) seen.add(corner(t, i));
        clip(seen, right_of);
        clip(seen, left_of);
        clip(seen, before);
        if (seen.size > 2) part({seen.at.data(), seen.size});
        for (std::size_t k = 1; k < 3; ++k) {
            const std::size_t i = (s.edge + k) % 3;
            Segment window{corner(t, i + 2), corner(t, i + 1)};
            if (clip(window, right_of) && clip(window, left_of)) through(t, i, window, s.stretch);
        }
    }
    return true;
}

}  // namespace vfplan
