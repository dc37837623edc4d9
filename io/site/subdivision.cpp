#include "io/site/subdivision.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "kernels/index.h"

namespace vfplan {
namespace {

// b lies on the straight way from a to c.
bool straight(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    const std::int64_t ux = b.x - a.x;
    const std::int64_t uy = b.y - a.y;
    const std::int64_t vx = c.x - b.x;
    const std::int64_t vy = c.y - b.y;
    return Wide(ux) * vy == Wide(uy) * vx && Wide(ux) * vx + Wide(uy) * vy > 0;
}

// Which class an edge has that lies on two: a window is part of a wall.
bool before(WallClass a, WallClass b) {
    const auto rank = [](WallClass c) { return c == WallClass::window ? -1 : static_cast<int>(c); };
    return rank(a) < rank(b);
}

struct LatticeWall {
    LatticePoint a;
    LatticePoint b;
    WallClass cls;
    EdgeUse use;
};

// Joins walls that meet in a point of no other, in one straight line and alike.
std::vector<LatticeWall> joined(std::vector<LatticeWall> walls) {
    std::map<LatticePoint, std::vector<std::size_t>> at;
    for (std::size_t i = 0; i < walls.size(); ++i) {
        at[walls[i].a].push_back(i);
        at[walls[i].b].push_back(i);
    }
    std::vector<bool> gone(walls.size(), false);
    for (const auto& [point, ends] : at) {
        if (ends.size() != 2) continue;
        const std::size_t i = ends[0];
        const std::size_t k = ends[1];
        if (i == k || walls[i].cls != walls[k].cls || walls[i].use != walls[k].use) continue;
        const LatticePoint from = walls[i].a == point ? walls[i].b : walls[i].a;
        const LatticePoint to = walls[k].a == point ? walls[k].b : walls[k].a;
        if (!straight(from, point, to)) continue;
        walls[i].a = std::min(from, to);  // as before: a < b, so left stays left
        walls[i].b = std::max(from, to);
        gone[k] = true;
        for (std::size_t& e : at[to]) {
            if (e == k) e = i;
        }
    }
    std::vector<LatticeWall> out;
    for (std::size_t i = 0; i < walls.size(); ++i) {
        if (!gone[i]) out.push_back(walls[i]);
    }
    return out;
}

// An edge between what nobody is kept out of, that a door or window made so: a line in it, or the
// border of a solid part of it.
bool opens(Kinds on_left, Kinds on_right, bool line_along) {
    const Kinds around = line_along ? on_left & on_right : on_left | on_right;
    return (around & bit(opened_area)) != 0;
}

}  // namespace

Subdivision subdivide(const Linework& linework, double margin_m) {
    Subdivision s;
    s.noded = node(linework.segments());
    const std::size_t edges = s.noded.edges.size();
    std::vector<AreaKind> kind_of;
    for (const Source& source : linework.sources()) kind_of.push_back(source.kind);
    std::vector<Wall> as_walls(edges);
    s.cls.resize(edges);
    s.line_along.resize(edges, false);
    for (std::size_t e = 0; e < edges; ++e) {
        as_walls[e].a = as_vec(s.noded.edges[e].a);
        as_walls[e].b = as_vec(s.noded.edges[e].b);
        for (const std::int32_t label : s.noded.labels_of(e)) {
            const Source& source = linework.sources()[idx(label)];
            if (source.cls && (!s.cls[e] || before(*source.cls, *s.cls[e]))) s.cls[e] = source.cls;
            if (source.cls && source.kind == line_kind) s.line_along[e] = true;
        }
    }
    s.triangles = triangulate(as_walls, {}, std::ceil(margin_m / linework.snap_m()) + 2);
    s.kinds = kinds_around(s.triangles, s.noded, kind_of);
    s.triangle_at.resize(edges, {-1, -1});
    for (std::size_t t = 0; t < s.triangles.triangles.size(); ++t) {
        const Triangle& triangle = s.triangles.triangles[t];
        for (std::size_t i = 0; i < 3; ++i) {
            if (triangle.wall[i] < 0) continue;
            // The triangle lies left of its sides.
            const std::size_t e = idx(triangle.wall[i]);
            const Vec2d& from = s.triangles.vertices[idx(triangle.vertex[(i + 1) % 3])];
            const Side side = from == as_walls[e].a ? left : right;
            s.triangle_at[e][side] = static_cast<std::int32_t>(t);
        }
    }
    return s;
}

std::vector<Vec2d> self_crossings(const Linework& linework, const Noded& noded) {
    std::vector<Vec2d> out;
    std::int32_t last = -1;
    for (const Noded::SelfCrossing& c : noded.self_crossings) {
        if (linework.sources()[idx(c.label)].kind == line_kind || c.label == last) continue;
        last = c.label;
        out.push_back(as_vec(c.at) * linework.snap_m());
    }
    return out;
}

void count_edges(const Linework& linework, const Noded& noded, CleaningCounts& counts) {
    std::int64_t long_enough = 0;
    for (const LabelledSegment& s : linework.segments()) {
        if (pixel_of(s.a) != pixel_of(s.b)) ++long_enough;
    }
    const auto read = static_cast<std::int64_t>(linework.segments().size());
    const auto stretches = static_cast<std::int64_t>(noded.labels.size());
    counts.edges_in += read;
    counts.zero_length += read - long_enough;
    counts.split += stretches - long_enough;
    counts.duplicates += stretches - static_cast<std::int64_t>(noded.edges.size());
}

void settle_openings(Subdivision& s) {
    for (std::size_t e = 0; e < s.noded.edges.size(); ++e) {
        const Kinds on_left = s.kinds[idx(s.triangle_at[e][left])];
        const Kinds on_right = s.kinds[idx(s.triangle_at[e][right])];
        if (is_taken(on_left) == is_taken(on_right)) continue;
        const Kinds solid = is_taken(on_left) ? on_left : on_right;
        const Kinds free = is_taken(on_left) ? on_right : on_left;
        if (!s.cls[e] && (free & bit(opened_area)) != 0) {
            s.cls[e] = (solid & bit(obstacle_area)) != 0 ? WallClass::obstacle : WallClass::wall;
        }
        if (s.cls[e] == WallClass::wall && (solid & bit(window_area)) != 0) {
            s.cls[e] = WallClass::window;
        }
    }
}

std::vector<EdgeUse> walls_among(const Subdivision& s, CleaningCounts& counts) {
    std::vector<EdgeUse> out(s.noded.edges.size());
    for (std::size_t e = 0; e < out.size(); ++e) {
        if (!s.cls[e]) continue;
        const Kinds on_left = s.kinds[idx(s.triangle_at[e][left])];
        const Kinds on_right = s.kinds[idx(s.triangle_at[e][right])];
        const bool left_taken = is_taken(on_left);
        const bool right_taken = is_taken(on_right);
        if (left_taken && right_taken) {
            ++counts.inside_solids;
        } else if (!left_taken && !right_taken && opens(on_left, on_right, s.line_along[e])) {
            ++counts.opened;
        } else if (!s.line_along[e] && left_taken == right_taken &&
                   (on_left & bit(outline_area)) == (on_right & bit(outline_area))) {
            ++counts.slivers;
        } else {
            out[e].kept = true;
        }
    }
    return out;
}

std::vector<Wall> walls_of(const Subdivision& s, double snap_m, const std::vector<EdgeUse>& use,
                           CleaningCounts& counts) {
    std::vector<LatticeWall> walls;
    walls.reserve(s.noded.edges.size());
    for (std::size_t e = 0; e < s.noded.edges.size(); ++e) {
        if (!s.cls[e]) continue;
        walls.push_back({s.noded.edges[e].a, s.noded.edges[e].b, *s.cls[e], use[e]});
    }
    const std::size_t before = walls.size();
    walls = joined(std::move(walls));
    counts.merged += static_cast<std::int64_t>(before - walls.size());
    std::vector<Wall> out;
    out.reserve(walls.size());
    for (const LatticeWall& w : walls) {
        if (!w.use.kept) continue;
        Wall wall;
        wall.a = as_vec(w.a) * snap_m;
        wall.b = as_vec(w.b) * snap_m;
        wall.cls = w.cls;
        wall.scanned = w.cls != WallClass::obstacle;
        wall.free_side[left] = w.use.free[left];
        wall.free_side[right] = w.use.free[right];
        out.push_back(wall);
    }
    return out;
}

double area_m2(const Subdivision& s, double snap_m,
               const std::function<bool(std::int32_t triangle)>& counts) {
    Wide twice = 0;
    for (std::size_t t = 0; t < s.triangles.triangles.size(); ++t) {
        if (!counts(static_cast<std::int32_t>(t))) continue;
        const auto corner = [&](std::size_t i) {
            const Vec2d& v = s.triangles.vertices[idx(s.triangles.triangles[t].vertex[i])];
            return LatticePoint{static_cast<std::int64_t>(v.x()), static_cast<std::int64_t>(v.y())};
        };
        twice += turn(corner(0), corner(1), corner(2));
    }
    return static_cast<double>(twice) / 2 * snap_m * snap_m;
}

void sort_walls(std::vector<Wall>& walls) {
    constexpr double side_m = 256;
    const auto square = [](double v) { return std::floor(v / side_m); };
    std::sort(walls.begin(), walls.end(), [&](const Wall& p, const Wall& q) {
        return std::tuple(square(p.a.y()), square(p.a.x()), p.a.x(), p.a.y(), p.b.x(), p.b.y()) <
               std::tuple(square(q.a.y()), square(q.a.x()), q.a.x(), q.a.y(), q.b.x(), q.b.y());
    });
}

}  // namespace vfplan
