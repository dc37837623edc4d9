#include "io/site/site_walls.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "io/site/planar.h"

namespace vfplan {
namespace {

using Point = std::pair<std::int64_t, std::int64_t>;  // in snaps

Point snapped(const Vec2d& p, double snap_m) {
    return {std::llround(p.x() / snap_m), std::llround(p.y() / snap_m)};
}

using Edge = std::pair<Point, Point>;

Edge edge_between(Point p, Point q) { return p < q ? Edge(p, q) : Edge(q, p); }

// Exactly straight through b, on the grid of snaps.
bool collinear(const Point& a, const Point& b, const Point& c) {
    const auto ux = b.first - a.first;
    const auto uy = b.second - a.second;
    const auto vx = c.first - b.first;
    const auto vy = c.second - b.second;
    return ux * vy == uy * vx && ux * vx + uy * vy > 0;
}

struct Classified {
    Point a;
    Point b;
    WallClass cls;
};

// Joins edges that meet in a point of no other edge, in one straight line and of one class.
std::vector<Classified> join_collinear(std::vector<Classified> edges) {
    std::map<Point, std::vector<std::size_t>> at;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        at[edges[i].a].push_back(i);
        at[edges[i].b].push_back(i);
    }
    std::vector<bool> gone(edges.size(), false);
    for (const auto& [point, ends] : at) {
        if (ends.size() != 2) continue;
        const std::size_t i = ends[0];
        const std::size_t k = ends[1];
        if (i == k || edges[i].cls != edges[k].cls) continue;
        const Point from = edges[i].a == point ? edges[i].b : edges[i].a;
        const Point to = edges[k].a == point ? edges[k].b : edges[k].a;
        if (!collinear(from, point, to)) continue;
        edges[i] = {from, to, edges[i].cls};
        gone[k] = true;
        for (std::size_t& e : at[to]) {
            if (e == k) e = i;
        }
    }
    std::vector<Classified> out;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (!gone[i]) out.push_back(edges[i]);
    }
    return out;
}

}  // namespace

void Blocking::add(const std::vector<Line>& more, WallClass c) {
    for (const Line& line : more) {
        lines.push_back(line);
        cls.push_back(c);
    }
}

void Blocking::add_rings(const std::vector<Polygon>& polygons, WallClass c) {
    const auto add_ring = [&](Line ring) {
        ring.push_back(ring.front());
        lines.push_back(std::move(ring));
        cls.push_back(c);
    };
    for (const Polygon& p : polygons) {
        add_ring(p.outer);
        for (const Ring& hole : p.holes) add_ring(hole);
    }
}

std::vector<Wall> walls_from_lines(const Blocking& blocking, double snap_m,
                                   CleaningCounts& counts) {
    std::set<Edge> before;
    for (const Line& line : blocking.lines) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            const Edge e = edge_between(snapped(line[i - 1], snap_m), snapped(line[i], snap_m));
            ++counts.edges_in;
            if (e.first == e.second) {
                ++counts.zero_length;
            } else if (!before.insert(e).second) {
                ++counts.duplicates;
            }
        }
    }
    const planar::LineIndex index(blocking.lines);
    std::vector<Classified> edges;
    std::set<Edge> after;
    for (const Line& line : planar::node(blocking.lines, snap_m)) {
        for (std::size_t i = 1; i < line.size(); ++i) {
            const Edge e = edge_between(snapped(line[i - 1], snap_m), snapped(line[i], snap_m));
            if (e.first == e.second || !after.insert(e).second) continue;
            auto cls = WallClass::obstacle;
            for (const std::size_t k : index.near((line[i - 1] + line[i]) / 2, 2 * snap_m)) {
                cls = std::min(cls, blocking.cls[k]);
            }
            edges.push_back({e.first, e.second, cls});
        }
    }
    for (const Edge& e : before) counts.split += after.contains(e) ? 0 : 1;
    const std::size_t noded = edges.size();
    edges = join_collinear(std::move(edges));
    counts.merged += static_cast<std::int64_t>(noded - edges.size());
    std::vector<Wall> walls;
    walls.reserve(edges.size());
    const auto metres = [&](const Point& p) {
        return Vec2d(static_cast<double>(p.first) * snap_m, static_cast<double>(p.second) * snap_m);
    };
    for (const Classified& e : edges) {
        const Edge ordered = edge_between(e.a, e.b);
        Wall wall;
        wall.a = metres(ordered.first);
        wall.b = metres(ordered.second);
        wall.cls = e.cls;
        walls.push_back(wall);
    }
    return walls;
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
