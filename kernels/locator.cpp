#include "kernels/locator.h"

#include <algorithm>
#include <cmath>

#include "kernels/index.h"

namespace vfplan {

TriangleLocator::TriangleLocator(const Triangulation& mesh, const Box& around) : mesh_(mesh) {
    const auto side = static_cast<std::int32_t>(
        std::max(1.0, std::sqrt(static_cast<double>(mesh_.triangles.size()) / 2)));
    seeds_origin_ = around.min;
    seeds_cell_m_ = std::max(around.size().maxCoeff(), 1e-3) / side;
    seeds_nx_ = side;
    seeds_.assign(idx(side) * idx(side), 0);
    std::int32_t last = 0;
    for (std::int32_t iy = 0; iy < side; ++iy) {
        for (std::int32_t k = 0; k < side; ++k) {
            const std::int32_t ix = iy % 2 == 0 ? k : side - 1 - k;  // stay near the last one
            const Vec2d centre = seeds_origin_ + seeds_cell_m_ * Vec2d(ix + 0.5, iy + 0.5);
            walk(last, centre, last);
            seeds_[idx(iy) * idx(side) + idx(ix)] = last;
        }
    }
}

double TriangleLocator::side_of(const Triangle& t, std::size_t edge, const Vec2d& eye) const {
    const std::int32_t u = t.vertex[(edge + 1) % 3];
    const std::int32_t v = t.vertex[(edge + 2) % 3];
    const Vec2d& a = mesh_.vertices[idx(u)];
    const Vec2d& b = mesh_.vertices[idx(v)];
    return u < v ? orient(a, b, eye) : -orient(b, a, eye);
}

bool TriangleLocator::contains(std::int32_t triangle, const Vec2d& eye) const {
    const Triangle& t = mesh_.triangles[idx(triangle)];
    for (std::size_t i = 0; i < 3; ++i) {
        if (side_of(t, i, eye) < 0) return false;
    }
    return true;
}

// Goes from triangle to triangle across an edge that has the eye on its far side. Such walks can
// circle in a constrained triangulation, so the first edge looked at turns with the steps.
bool TriangleLocator::walk(std::int32_t from, const Vec2d& eye, std::int32_t& found) const {
    std::int32_t t = from;
    const std::size_t limit = 64 + 4 * mesh_.triangles.size();
    for (std::size_t step = 0; step < limit; ++step) {
        const Triangle& tri = mesh_.triangles[idx(t)];
        std::int32_t next = t;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + step) % 3;
            if (side_of(tri, i, eye) < 0 && tri.neighbour[i] >= 0) {
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

// An eye on an edge stands in two triangles, on a vertex in a fan of them.
std::int32_t TriangleLocator::lowest_of(std::int32_t triangle, const Vec2d& eye) const {
    const auto on_edge = [&](std::int32_t t) {
        const Triangle& tri = mesh_.triangles[idx(t)];
        return side_of(tri, 0, eye) == 0 || side_of(tri, 1, eye) == 0 || side_of(tri, 2, eye) == 0;
    };
    if (!on_edge(triangle)) return triangle;
    std::vector<std::int32_t> holding = {triangle};
    for (std::size_t k = 0; k < holding.size(); ++k) {
        for (const std::int32_t n : mesh_.triangles[idx(holding[k])].neighbour) {
            if (n >= 0 && contains(n, eye) &&
                std::find(holding.begin(), holding.end(), n) == holding.end()) {
                holding.push_back(n);
            }
        }
    }
    return *std::min_element(holding.begin(), holding.end());
}

std::int32_t TriangleLocator::locate(const Vec2d& eye, std::int32_t near) const {
    if (near < 0) {
        const Vec2d cell = (eye - seeds_origin_) / seeds_cell_m_;
        const auto clamp = [&](double v) {
            return static_cast<std::int64_t>(
                std::clamp(v, 0.0, static_cast<double>(seeds_nx_ - 1)));
        };
        near = seeds_[idx(clamp(cell.y()) * seeds_nx_ + clamp(cell.x()))];
    }
    std::int32_t found = 0;
    if (walk(near, eye, found)) return contains(found, eye) ? lowest_of(found, eye) : -1;
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        if (contains(static_cast<std::int32_t>(t), eye)) return static_cast<std::int32_t>(t);
    }
    return -1;
}

}  // namespace vfplan
