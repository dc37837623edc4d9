#include "kernels/exact_scene.h"
#include "kernels/index.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vfplan {
namespace {

// A cone of sight about to leave `triangle` through `edge`. Its two borders are the rays through
// the vertices `right` and `left`.
struct Cone {
    std::int32_t triangle;
    std::int32_t edge;
    std::int32_t right;
    std::int32_t left;
};

double squared_distance_to_segment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
    const Vec2d e = b - a;
    const double t = std::clamp((p - a).dot(e) / e.squaredNorm(), 0.0, 1.0);
    return (a + e * t - p).squaredNorm();
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

}  // namespace

ExactScene::ExactScene(const std::vector<Wall>& walls, const Box& around, double reach_m)
    : walls_(walls),
      mesh_(triangulate(walls, around, 10 + 1.5 * around.size().norm())),
      reach_m_(reach_m) {
    const auto side = static_cast<std::int32_t>(
        std::max(1.0, std::sqrt(static_cast<double>(mesh_.triangles.size()) / 2)));
    seeds_origin_ = around.min;
    seeds_cell_m_ = std::max(around.size().maxCoeff(), 1e-3) / side;
    seeds_nx_ = side;
    seeds_.assign(at(side) * at(side), 0);
    std::int32_t last = 0;
    for (std::int32_t iy = 0; iy < side; ++iy) {
        for (std::int32_t k = 0; k < side; ++k) {
            const std::int32_t ix = iy % 2 == 0 ? k : side - 1 - k;  // stay near the last one
            const Vec2d centre = seeds_origin_ + seeds_cell_m_ * Vec2d(ix + 0.5, iy + 0.5);
            walk(last, centre, last);
            seeds_[at(iy) * at(side) + at(ix)] = last;
        }
    }
}

// Goes from triangle to triangle across an edge that has p on its far side. Such walks can
// circle in a constrained triangulation, so the first edge looked at turns with the steps.
bool ExactScene::walk(std::int32_t from, const Vec2d& eye, std::int32_t& found) const {
    std::int32_t t = from;
    const std::size_t limit = 64 + 4 * mesh_.triangles.size();
    for (std::size_t step = 0; step < limit; ++step) {
        const Triangle& tri = mesh_.triangles[at(t)];
        std::int32_t next = t;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + step) % 3;
            const Vec2d& a = mesh_.vertices[at(tri.vertex[(i + 1) % 3])];
            const Vec2d& b = mesh_.vertices[at(tri.vertex[(i + 2) % 3])];
            if (orient(a, b, eye) < 0 && tri.neighbour[i] >= 0) {
                next = tri.neighbour[i];
                break;
            }
        }
        if (next == t) {
            found = t;
            return true;
        }
        t = next;
    }
    return false;
}

std::int32_t ExactScene::locate(const Vec2d& eye) const {
    const Vec2d cell = (eye - seeds_origin_) / seeds_cell_m_;
    const auto clamp = [&](double v) {
        return static_cast<std::int32_t>(std::clamp(v, 0.0, static_cast<double>(seeds_nx_ - 1)));
    };
    std::int32_t found = 0;
    if (walk(seeds_[at(clamp(cell.y())) * at(seeds_nx_) + at(clamp(cell.x()))], eye, found)) {
        return found;
    }
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        const auto& v = mesh_.triangles[t].vertex;
        const Vec2d& a = mesh_.vertices[at(v[0])];
        const Vec2d& b = mesh_.vertices[at(v[1])];
        const Vec2d& c = mesh_.vertices[at(v[2])];
        if (orient(a, b, eye) >= 0 && orient(b, c, eye) >= 0 && orient(c, a, eye) >= 0) {
            return static_cast<std::int32_t>(t);
        }
    }
    return -1;
}

// Adds the part of `wall` between the rays through two vertices, joined to the span before it
// where a cone was split at a vertex that hides nothing.
void ExactScene::emit(const Vec2d& eye, std::int32_t wall_id, std::int32_t right_vertex,
                      std::int32_t left_vertex, View& out) const {
    const Wall& wall = walls_[at(wall_id)];
    const double side = orient(wall.a, wall.b, eye);
    if (side == 0) return;  // edge-on: no angle
    const double length = wall.length_m();
    const auto shadow = [&](std::int32_t vertex) {
        const Vec2d& p = mesh_.vertices[at(vertex)];
        if (p == wall.a) return 0.0;
        if (p == wall.b) return length;
        const Vec2d d = p - eye;
        const double u = cross(wall.a - eye, d) / cross(d, wall.b - wall.a);
        return length * std::clamp(u, 0.0, 1.0);
    };
    const Span span{wall_id, side > 0 ? left : right, shadow(right_vertex), shadow(left_vertex), 0};
    if (!out.empty() && out.back().wall == span.wall && out.back().s_end_m == span.s_begin_m) {
        out.back().s_end_m = span.s_end_m;
    } else {
        out.push_back(span);
    }
}

void ExactScene::first_hits(const Vec2d& eye, View& out) const {
    out.clear();
    const std::int32_t start = locate(eye);
    if (start < 0) return;
    const double reach2 = reach_m_ * reach_m_;
    std::vector<Cone> stack;  // the next cone counter-clockwise on top
    stack.reserve(64);
    for (std::int32_t i = 2; i >= 0; --i) {
        const auto& v = mesh_.triangles[at(start)].vertex;
        stack.push_back({start, i, v[at(i + 1) % 3], v[at(i + 2) % 3]});
    }
    while (!stack.empty()) {
        const Cone cone = stack.back();
        stack.pop_back();
        const Triangle& here = mesh_.triangles[at(cone.triangle)];
        const auto edge = at(cone.edge);
        if (here.wall[edge] >= 0) {
            emit(eye, here.wall[edge], cone.right, cone.left, out);
            continue;
        }
        const std::int32_t across = here.neighbour[edge];
        if (across < 0) continue;
        const Vec2d& a = mesh_.vertices[at(here.vertex[(edge + 1) % 3])];
        const Vec2d& b = mesh_.vertices[at(here.vertex[(edge + 2) % 3])];
        if (squared_distance_to_segment(eye, a, b) > reach2) continue;

        const Triangle& next = mesh_.triangles[at(across)];
        const auto entry = at(static_cast<std::int32_t>(
            std::find(next.neighbour.begin(), next.neighbour.end(), cone.triangle) -
            next.neighbour.begin()));
        const std::int32_t apex = next.vertex[entry];
        const Vec2d to_apex = mesh_.vertices[at(apex)] - eye;
        const bool opens_right = cross(mesh_.vertices[at(cone.right)] - eye, to_apex) > 0;
        const bool opens_left = cross(to_apex, mesh_.vertices[at(cone.left)] - eye) > 0;
        const auto right_edge = static_cast<std::int32_t>((entry + 1) % 3);
        const auto left_edge = static_cast<std::int32_t>((entry + 2) % 3);
        if (opens_left) {
            stack.push_back({across, left_edge, opens_right ? apex : cone.right, cone.left});
        }
        if (opens_right) {
            stack.push_back({across, right_edge, cone.right, opens_left ? apex : cone.left});
        }
    }
    join_first_and_last(out);
}

}  // namespace vfplan
