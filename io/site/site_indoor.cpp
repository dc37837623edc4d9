#include "io/site/site_indoor.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "io/site/ground.h"
#include "io/site/openings.h"
#include "io/site/subdivision.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

void add_all(Linework& to, const FeaturesByRole& in, Role role, const Source& source) {
    for (const Polygon& p : in.polys(role)) to.add(p, source);
    for (const Line& line : in.line(role)) to.add(line, source);
}

// What is a wall, by the job's choices about doors and windows.
Linework wall_linework(const FeaturesByRole& in, const SiteOptions& options) {
    Linework out(options.snap_m);
    constexpr Source solid_wall{solid_area, WallClass::wall};
    for (const Role r : {Role::wall, Role::building}) add_all(out, in, r, solid_wall);
    add_all(out, in, Role::outline, {outline_area, WallClass::wall});
    add_all(out, in, Role::obstacle, {obstacle_area, WallClass::obstacle});
    constexpr Source opening{opened_area, {}};
    if (options.windows != WindowMode::opening) {
        add_all(out, in, Role::window, {window_area, WallClass::window});
    } else {
        for (const Polygon& p : in.polys(Role::window)) out.add(p, opening);
    }
    if (options.doors == DoorMode::closed) {
        add_all(out, in, Role::door, {solid_area, WallClass::door});
    } else {
        for (const Polygon& p : in.polys(Role::door)) out.add(p, opening);
    }
    return out;
}

// What parts the ground without being a wall.
void add_borders(Linework& to, const FeaturesByRole& in, const SiteOptions& options) {
    add_all(to, in, Role::room, {room_area, {}});
    add_all(to, in, Role::opening, {line_kind, {}, true});
    if (options.windows == WindowMode::opening)
        add_all(to, in, Role::window, {line_kind, {}, true});
    if (options.doors == DoorMode::open) add_all(to, in, Role::door, {doorway_area, {}, true});
}

// Places on walls right across from a wall's end that is nearer than `near`, in lattice steps. With
// nodes there, every bottleneck between walls has an edge of the triangulation across it.
std::vector<LatticePoint> feet(const std::vector<Noded::Edge>& walls, double near) {
    using Square = std::pair<std::int64_t, std::int64_t>;
    const auto square = [&](double v) { return static_cast<std::int64_t>(std::floor(v / near)); };
    std::map<Square, std::vector<Vec2d>> ends;
    for (const Noded::Edge& w : walls) {
        for (const LatticePoint& p : {w.a, w.b}) {
            const Vec2d v = as_vec(p);
            ends[{square(v.x()), square(v.y())}].push_back(v);
        }
    }
    std::vector<LatticePoint> out;
    for (const Noded::Edge& w : walls) {
        const Vec2d a = as_vec(w.a);
        const Vec2d e = as_vec(w.b) - a;
        const Vec2d reach(near, near);
        const Vec2d lo = as_vec(w.b).cwiseMin(a) - reach;
        const Vec2d hi = as_vec(w.b).cwiseMax(a) + reach;
        for (std::int64_t x = square(lo.x()); x <= square(hi.x()); ++x) {
            for (auto at = ends.lower_bound({x, square(lo.y())});
                 at != ends.end() && at->first <= Square(x, square(hi.y())); ++at) {
                for (const Vec2d& v : at->second) {
                    const double t = (v - a).dot(e) / e.squaredNorm();
                    if (t <= 0 || t >= 1 || (a + t * e - v).squaredNorm() > near * near) continue;
                    const Vec2d foot = a + t * e;
                    out.push_back({std::llround(foot.x()), std::llround(foot.y())});
                }
            }
        }
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

// The walls' subdivision with everything else in it that parts ground. Noding moves places by up to
// half a snap, so walls are not read from it, only what lies at their sides.
class Plan {
public:
    Plan(const Subdivision& walls, const std::vector<EdgeUse>& use, const Linework& drawn,
         const FeaturesByRole& in, const SiteOptions& options)
        : options_(options), walls_(walls) {
        Linework work(options.snap_m);
        std::vector<std::int32_t> label_of;  // of the linework that walls were made of
        for (const Source& source : drawn.sources()) {
            label_of.push_back(work.add({0, 0}, {0, 0}, {source.kind, {}, false}));
        }
        first_wall_ = label_of.size();
        std::vector<Noded::Edge> kept;
        for (std::size_t e = 0; e < use.size(); ++e) {
            const Noded::Edge& edge = walls.noded.edges[e];
            if (use[e].kept) {
                work.add(edge.a, edge.b, {line_kind, walls.cls[e], false});
                edge_of_.push_back(e);
                kept.push_back(edge);
            }
        }
        for (std::size_t e = 0; e < use.size(); ++e) {
            const Noded::Edge& edge = walls.noded.edges[e];
            for (const std::int32_t label : walls.noded.labels_of(e)) {
                if (drawn.sources()[idx(label)].kind != line_kind) {
                    work.add(edge.a, edge.b, label_of[idx(label)]);
                }
            }
        }
        add_borders(work, in, options);
        for (const LatticePoint& p : feet(kept, options.max_opening_m / options.snap_m)) {
            work.add(p, p, {line_kind, {}, false});
        }
        s_ = subdivide(work, 2 * options.max_opening_m);
        const std::size_t edges = s_.noded.edges.size();
        wall_.resize(edges);
        shut_.resize(edges);
        for (std::size_t e = 0; e < edges; ++e) {
            wall_[e] = s_.cls[e].has_value();
            for (const std::int32_t label : s_.noded.labels_of(e)) {
                if (work.sources()[idx(label)].shut) shut_[e] = true;
            }
        }
    }

    std::vector<OpeningStep> opening_steps() const {
        return vfplan::opening_steps(s_, wall_, shut_, options_.snap_m, options_.max_opening_m);
    }
    Ground find() const { return find_ground(s_, wall_, shut_, options_); }

    // A wall's side is free where the ground reaches any of it.
    void set_free_sides(const Ground& ground, std::vector<EdgeUse>& use) const {
        each_wall_along([&](std::size_t wall, std::size_t e) {
            const bool same_way = runs_along(walls_.noded.edges[wall], s_.noded.edges[e]);
            for (const Side side : {left, right}) {
                if (!ground.reached[idx(s_.triangle_at[e][side])]) continue;
                use[wall].free[same_way ? side : (side == left ? right : left)] = true;
            }
        });
    }

    // Closed rings around triangles. What lies along a wall lies on it, not where noding
    // put it.
    std::vector<Border> border(const std::vector<bool>& inside) const {
        std::map<LatticePoint, Vec2d> moved;
        each_wall_along([&](std::size_t wall, std::size_t e) {
            const Noded::Edge& edge = walls_.noded.edges[wall];
            for (const LatticePoint& p : {s_.noded.edges[e].a, s_.noded.edges[e].b}) {
                if (p == edge.a || p == edge.b) continue;
                const Vec2d a = metres(edge.a);
                const Vec2d along = metres(edge.b) - a;
                moved.emplace(p, a + along * ((metres(p) - a).dot(along) / along.squaredNorm()));
            }
        });
        for (const std::size_t wall : edge_of_) {
            moved.erase(walls_.noded.edges[wall].a);
            moved.erase(walls_.noded.edges[wall].b);
        }
        const auto place = [&](std::int32_t vertex) {
            const Vec2d& v = s_.triangles.vertices[idx(vertex)];
            const LatticePoint p{static_cast<std::int64_t>(v.x()),
                                 static_cast<std::int64_t>(v.y())};
            const auto known = moved.find(p);
            return known == moved.end() ? metres(p) : known->second;
        };
        std::vector<Border> out;
        for (std::size_t t = 0; t < s_.triangles.triangles.size(); ++t) {
            if (!inside[t]) continue;
            const Triangle& triangle = s_.triangles.triangles[t];
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int32_t to = triangle.neighbour[i];
                if (to >= 0 && inside[idx(to)]) continue;
                out.push_back(
                    {place(triangle.vertex[(i + 1) % 3]), place(triangle.vertex[(i + 2) % 3])});
            }
        }
        return out;
    }

private:
    // Calls f(edge of the walls' subdivision, edge of this one) where one was led along the other,
    // and no second: where noding laid walls on each other, near their ends, sides tell nothing.
    template <class F>
    void each_wall_along(F&& f) const {
        for (std::size_t e = 0; e < s_.noded.edges.size(); ++e) {
            std::size_t walls = 0;
            std::size_t wall = 0;
            for (const std::int32_t label : s_.noded.labels_of(e)) {
                const std::size_t number = idx(label) - first_wall_;
                if (idx(label) < first_wall_ || number >= edge_of_.size()) continue;
                ++walls;
                wall = edge_of_[number];
            }
            if (walls == 1) f(wall, e);
        }
    }
    static bool runs_along(const Noded::Edge& wall, const Noded::Edge& e) {
        return Wide(wall.b.x - wall.a.x) * (e.b.x - e.a.x) +
                   Wide(wall.b.y - wall.a.y) * (e.b.y - e.a.y) >
               0;
    }
    Vec2d metres(const LatticePoint& p) const { return as_vec(p) * options_.snap_m; }

    const SiteOptions& options_;
    const Subdivision& walls_;
    Subdivision s_;
    std::size_t first_wall_ = 0;
    std::vector<std::size_t> edge_of_;  // by label, from the first wall's
    std::vector<bool> wall_;            // by edge
    std::vector<bool> shut_;
};

}  // namespace

std::vector<OpeningStep> indoor_opening_steps(const FeaturesByRole& in, SiteOptions options,
                                              double up_to_m) {
    options.max_opening_m = up_to_m;
    const Linework drawn = wall_linework(in, options);
    Subdivision walls = subdivide(drawn);
    settle_openings(walls);
    CleaningCounts ignored;
    const std::vector<EdgeUse> use = walls_among(walls, ignored);
    return Plan(walls, use, drawn, in, options).opening_steps();
}

void build_indoor(const FeaturesByRole& in, const SiteOptions& options, Site& site) {
    const Linework drawn = wall_linework(in, options);
    Subdivision walls = subdivide(drawn);
    settle_openings(walls);
    count_edges(drawn, walls.noded, site.counts);
    site.repaired_at = self_crossings(drawn, walls.noded);
    std::vector<EdgeUse> use = walls_among(walls, site.counts);
    const Plan plan(walls, use, drawn, in, options);
    Ground ground = plan.find();
    plan.set_free_sides(ground, use);
    site.walls = walls_of(walls, options.snap_m, use, site.counts);
    for (Wall& wall : site.walls) {
        if (wall.cls == WallClass::window && options.windows == WindowMode::ignore) {
            wall.scanned = false;
        }
        site.extent.add(wall.a);
        site.extent.add(wall.b);
    }
    sort_walls(site.walls);
    site.free_border = plan.border(ground.free);
    site.left_out_border = plan.border(ground.left_out);
    site.area_m2 = ground.area_m2;
    site.dropped = std::move(ground.dropped);
    const auto rooms = static_cast<std::int64_t>(in.polys(Role::room).size());
    site.buildings = rooms > 0 ? rooms : ground.parts;
}

}  // namespace vfplan
