#include "kernels/exact_scene.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"
#include "kernels/packet_angles.h"
#include "kernels/shadow.h"

namespace vfplan {
namespace {

// A cone of sight about to pass an edge; all points relative to the eye. Its borders are rays
// through vertices.
struct Cone {
    Behind behind;
    Vec2d right;  // borders
    Vec2d left;
    Vec2d edge_right;  // the edge's ends
    Vec2d edge_left;
};

bool nearer_than(double reach2, const Vec2d& a, const Vec2d& b) {
    const Vec2d e = b - a;
    const double t = std::clamp(-a.dot(e) / e.squaredNorm(), 0.0, 1.0);
    return (a + e * t).squaredNorm() <= reach2;
}

// Adds the part of a wall between two directions, joined to the span before it where a cone was
// split at a vertex that hides nothing.
void emit(const Wall& wall, std::int32_t id, const Vec2d& eye, const Cone& cone, View& out) {
    const double side = orient(wall.a, wall.b, eye);
    if (side == 0) return;  // edge-on: no angle
    const double length = wall.length_m();
    const Span span{id, side > 0 ? left : right, shadow_m(wall, length, eye, cone.right),
                    shadow_m(wall, length, eye, cone.left), 0};
    if (!out.empty() && out.back().wall == span.wall && out.back().s_end_m == span.s_begin_m) {
        out.back().s_end_m = span.s_end_m;
    } else {
        out.push_back(span);
    }
}

// The first cone began at a vertex of the eye's triangle, perhaps in the middle of a wall.
void join_first_and_last(View& view) {
    if (view.size() < 2) return;
    Span& first = view.front();
    const Span& last = view.back();
    if (first.wall != last.wall || last.s_end_m != first.s_begin_m) return;
    first.s_begin_m = last.s_begin_m;
    view.pop_back();
}

// Eyes in order of the triangle they stand in.
struct Eyes {
    struct Place {
        std::int32_t triangle;
        std::int32_t eye;
    };
    std::vector<Place> places;
    std::vector<double> x;
    std::vector<double> y;
    std::vector<double> vf_rad;
};

}  // namespace

ExactScene::ExactScene(const std::vector<Wall>& walls, const Box& around, double reach_m)
    : walls_(walls),
      expansion_(triangulate(walls, around, 10 + 1.5 * around.size().norm())),
      locator_(expansion_.mesh, around),
      reach_m_(reach_m) {}

void ExactScene::first_hits(const Vec2d& eye, View& out) const {
    out.clear();
    const std::int32_t start = locator_.locate(eye);
    if (start < 0) return;
    const double reach2 = reach_m_ * reach_m_;
    thread_local std::vector<Cone> stack;  // the next cone counter-clockwise on top
    stack.clear();
    const Triangle& triangle = expansion_.mesh.triangles[idx(start)];
    for (std::size_t i = 3; i-- > 0;) {
        const Vec2d r = expansion_.mesh.vertices[idx(triangle.vertex[(i + 1) % 3])] - eye;
        const Vec2d l = expansion_.mesh.vertices[idx(triangle.vertex[(i + 2) % 3])] - eye;
        stack.push_back({expansion_.behind(start, i), r, l, r, l});
    }
    while (!stack.empty()) {
        const Cone cone = stack.back();
        stack.pop_back();
        if (is_wall(cone.behind)) {
            const std::int32_t wall = wall_of(cone.behind);
            emit(walls_[idx(wall)], wall, eye, cone, out);
            continue;
        }
        if (cone.behind == behind_hull) continue;
        if (!nearer_than(reach2, cone.edge_right, cone.edge_left)) continue;
        const Crossing& c = expansion_.crossings[idx(cone.behind)];
        const Vec2d apex = Vec2d(c.apex_x, c.apex_y) - eye;
        const bool opens_right = cross(cone.right, apex) > 0;
        const bool opens_left = cross(apex, cone.left) > 0;
        if (opens_left) {
            stack.push_back(
                {c.left, opens_right ? apex : cone.right, cone.left, apex, cone.edge_left});
        }
        if (opens_right) {
            stack.push_back(
                {c.right, cone.right, opens_left ? apex : cone.left, cone.edge_right, apex});
        }
    }
    join_first_and_last(out);
}

FieldCounts ExactScene::angles(const Scanner& scanner, const std::vector<Vec2d>& eyes,
                               std::vector<double>& vf_rad) const {
    thread_local Eyes mine;
    thread_local PacketStack stack;
    Eyes& e = mine;
    const std::size_t n = eyes.size();
    e.places.clear();
    std::int32_t triangle = -1;
    for (std::size_t i = 0; i < n; ++i) {
        triangle = locator_.locate(eyes[i], triangle);
        e.places.push_back({triangle, static_cast<std::int32_t>(i)});
    }
    std::stable_sort(
        e.places.begin(), e.places.end(),
        [](const Eyes::Place& a, const Eyes::Place& b) { return a.triangle < b.triangle; });
    e.x.resize(n);
    e.y.resize(n);
    e.vf_rad.assign(n, 0);
    for (std::size_t i = 0; i < n; ++i) {
        e.x[i] = eyes[idx(e.places[i].eye)].x();
        e.y[i] = eyes[idx(e.places[i].eye)].y();
    }
    FieldCounts counts;
    for (std::size_t i = 0; i < n;) {
        std::size_t end = i + 1;
        while (end < n && e.places[end].triangle == e.places[i].triangle) ++end;
        if (e.places[i].triangle >= 0) {
            packet_angles(expansion_, walls_, scanner, e.places[i].triangle, &e.x[i], &e.y[i],
                          end - i, &e.vf_rad[i], stack, counts);
        }
        i = end;
    }
    vf_rad.resize(n);
    for (std::size_t i = 0; i < n; ++i) vf_rad[idx(e.places[i].eye)] = e.vf_rad[i];
    return counts;
}

FieldCounts ExactScene::field(const Scanner& scanner, const Grid& grid, const Window& window,
                              const Raster<std::uint8_t>& standable, Raster<float>& vf_rad) const {
    std::vector<std::int64_t> cells;
    std::vector<Vec2d> eyes;
    std::vector<double> vf;
    for (std::int32_t iy = window.y_begin; iy < window.y_end; ++iy) {
        const bool even = (iy - window.y_begin) % 2 == 0;  // there and back, to stay near
        for (std::int32_t k = 0; k < window.x_end - window.x_begin; ++k) {
            const std::int32_t ix = even ? window.x_begin + k : window.x_end - 1 - k;
            const std::int64_t cell = grid.id(ix, iy);
            if (standable[idx(cell)] == 0) continue;
            cells.push_back(cell);
            eyes.push_back(grid.centre(cell));
        }
    }
    const FieldCounts counts = angles(scanner, eyes, vf);
    for (std::size_t i = 0; i < cells.size(); ++i)
        vf_rad[idx(cells[i])] = static_cast<float>(vf[i]);
    return counts;
}

}  // namespace vfplan
