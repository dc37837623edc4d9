#include "kernels/triangulation.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <unordered_map>

#include "kernels/error.h"

namespace vfplan {
namespace {

using K = CGAL::Exact_predicates_inexact_constructions_kernel;
using Vb = CGAL::Triangulation_vertex_base_with_info_2<std::int32_t, K>;
using Fb = CGAL::Constrained_triangulation_face_base_2<K>;
using Cdt = CGAL::Constrained_Delaunay_triangulation_2<
    K, CGAL::Triangulation_data_structure_2<Vb, Fb>,
    CGAL::No_constraint_intersection_requiring_constructions_tag>;

std::uint64_t edge_key(std::int32_t u, std::int32_t v) {
    const auto lo = static_cast<std::uint64_t>(std::min(u, v));
    const auto hi = static_cast<std::uint64_t>(std::max(u, v));
    return lo << 32 | hi;
}

// Numbers the distinct end points in order of x, then y, so that the arrays depend on the set of
// walls only.
struct Points {
    std::vector<Vec2d> at;
    std::ptrdiff_t sorted = 0;  // the far corners that are appended later are not

    explicit Points(const std::vector<Wall>& walls) {
        at.reserve(2 * walls.size());
        for (const Wall& w : walls) {
            at.push_back(w.a);
            at.push_back(w.b);
        }
        std::sort(at.begin(), at.end(), before);
        at.erase(std::unique(at.begin(), at.end()), at.end());
        sorted = static_cast<std::ptrdiff_t>(at.size());
    }
    static bool before(const Vec2d& p, const Vec2d& q) {
        return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y());
    }
    std::int32_t id(const Vec2d& p) const {
        return static_cast<std::int32_t>(
            std::lower_bound(at.begin(), at.begin() + sorted, p, before) - at.begin());
    }
};

}  // namespace

Triangulation triangulate(const std::vector<Wall>& walls, const Box& around, double margin_m) {
    Points points(walls);
    Box box = around;
    for (const Vec2d& p : points.at) box.add(p);
    const Vec2d lo = box.min - Vec2d(margin_m, margin_m);
    const Vec2d hi = box.max + Vec2d(margin_m, margin_m);
    for (const Vec2d& corner : {lo, Vec2d(hi.x(), lo.y()), hi, Vec2d(lo.x(), hi.y())}) {
        points.at.push_back(corner);
    }

    std::vector<std::pair<K::Point_2, std::int32_t>> sites;
    sites.reserve(points.at.size());
    for (std::size_t i = 0; i < points.at.size(); ++i) {
        sites.emplace_back(K::Point_2(points.at[i].x(), points.at[i].y()),
                           static_cast<std::int32_t>(i));
    }
    Cdt cdt;
    cdt.insert(sites.begin(), sites.end());
    std::vector<Cdt::Vertex_handle> handle(points.at.size());
    for (auto v = cdt.finite_vertices_begin(); v != cdt.finite_vertices_end(); ++v) {
        handle[static_cast<std::size_t>(v->info())] = v;
    }

    std::unordered_map<std::uint64_t, std::int32_t> wall_of_edge;
    wall_of_edge.reserve(walls.size());
    try {
        for (std::size_t i = 0; i < walls.size(); ++i) {
            const std::int32_t u = points.id(walls[i].a);
            const std::int32_t v = points.id(walls[i].b);
            cdt.insert_constraint(handle[static_cast<std::size_t>(u)],
                                  handle[static_cast<std::size_t>(v)]);
            wall_of_edge.emplace(edge_key(u, v), static_cast<std::int32_t>(i));
        }
    } catch (const Cdt::Intersection_of_constraints_exception&) {
        throw InputError("walls cross each other after cleaning; report this site");
    }

    Triangulation out;
    out.vertices = std::move(points.at);
    std::unordered_map<Cdt::Face_handle, std::int32_t> number;
    number.reserve(cdt.number_of_faces());
    for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
        number.emplace(f, static_cast<std::int32_t>(number.size()));
    }
    out.triangles.reserve(number.size());
    std::size_t walls_found = 0;
    for (auto f = cdt.finite_faces_begin(); f != cdt.finite_faces_end(); ++f) {
        Triangle t{};
        for (int i = 0; i < 3; ++i) {
            const auto k = static_cast<std::size_t>(i);
            t.vertex[k] = f->vertex(i)->info();
            const auto next = number.find(f->neighbor(i));
            t.neighbour[k] = next == number.end() ? -1 : next->second;
            t.wall[k] = -1;
            if (!f->is_constrained(i)) continue;
            const auto wall = wall_of_edge.find(
                edge_key(f->vertex(Cdt::ccw(i))->info(), f->vertex(Cdt::cw(i))->info()));
            if (wall == wall_of_edge.end()) {
                throw InputError("walls overlap each other after cleaning; report this site");
            }
            t.wall[k] = wall->second;
            ++walls_found;
        }
        out.triangles.push_back(t);
    }
    if (walls_found != 2 * wall_of_edge.size()) {
        throw InputError("a wall runs through another's end after cleaning; report this site");
    }
    return out;
}

}  // namespace vfplan
