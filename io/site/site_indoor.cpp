#include "io/site/site_indoor.h"

#include <algorithm>

#include "io/site/planar.h"
#include "io/site/site_walls.h"

namespace vfplan {
namespace {

constexpr double doorway_half_m = 0.3;  // how far a doorway reaches to both sides of its line
constexpr double gap_half_m = 0.6;      // openings up to twice this do not let the outside in
constexpr double slit_half_m = 0.15;    // narrower is the inside of a wall, no place to stand
constexpr double beside_line_m = 0.01;  // where the free side of a line wall is looked for
constexpr double beside_solid_m = 0.1;  // rooms may be drawn a few centimetres off thick walls

void append(std::vector<Polygon>& to, const std::vector<Polygon>& more) {
    to.insert(to.end(), more.begin(), more.end());
}

// True when a two-point line has p and q on different sides and lies between them.
bool separates(const Line& line, const Vec2d& p, const Vec2d& q) {
    return orient(line[0], line[1], p) * orient(line[0], line[1], q) < 0 &&
           orient(p, q, line[0]) * orient(p, q, line[1]) <= 0;
}

// What lies inside when nothing that names rooms or an outline is given: the ground that a disc
// of radius gap_half_m cannot reach from outside.
std::vector<Polygon> enclosed(const std::vector<Line>& walls) {
    std::vector<Polygon> shells;
    for (Polygon p : planar::strips(walls, gap_half_m, false)) {
        p.holes.clear();
        shells.push_back(std::move(p));
    }
    return planar::grow(shells, -gap_half_m);
}

// The parts of `space` in which a person could stand: what is left when the walls are grown by
// half a slit's width, grown back. The inside of doubled walls is gone then, open ends or not.
std::vector<Polygon> standable(const std::vector<Polygon>& space, const std::vector<Line>& walls,
                               double snap_m, double radius_m) {
    std::vector<Polygon> grown;
    for (const Polygon& core :
         planar::subtract(space, planar::strips(walls, slit_half_m, false), snap_m)) {
        if (planar::inscribed_radius(core) < radius_m - slit_half_m) continue;
        append(grown, planar::grow({core}, slit_half_m));
    }
    return planar::intersect(grown, space, snap_m);
}

}  // namespace

void build_indoor(const FeaturesByRole& in, const SiteOptions& options, Site& site) {
    const double snap = options.snap_m;
    std::vector<Polygon> solids = in.polys(Role::wall);
    append(solids, in.polys(Role::building));
    const std::vector<Polygon>& obstacles = in.polys(Role::obstacle);
    std::vector<Polygon> doorways;

    Blocking blocking;
    if (options.windows != WindowMode::opening) {
        blocking.add(in.line(Role::window), WallClass::window);
        blocking.add_rings(in.polys(Role::window), WallClass::window);
    }
    if (options.doors == DoorMode::open) {
        append(doorways, in.polys(Role::door));
        append(doorways, planar::strips(in.line(Role::door), doorway_half_m, true));
    } else {
        blocking.add(in.line(Role::door), WallClass::door);
        append(solids, in.polys(Role::door));
    }
    if (options.windows != WindowMode::opening) append(solids, in.polys(Role::window));
    const std::vector<Polygon> solid_walls = planar::unite(solids, snap);
    const std::vector<Polygon> outlines = planar::unite(in.polys(Role::outline), snap);
    blocking.add_rings(solid_walls, WallClass::wall);
    blocking.add_rings(outlines, WallClass::wall);
    blocking.add(in.line(Role::wall), WallClass::wall);
    blocking.add(in.line(Role::outline), WallClass::wall);
    blocking.add(in.line(Role::building), WallClass::wall);
    blocking.add_rings(obstacles, WallClass::obstacle);
    blocking.add(in.line(Role::obstacle), WallClass::obstacle);

    std::vector<Polygon> space;
    if (!outlines.empty()) {
        space = outlines;
    } else if (!in.polys(Role::room).empty()) {
        space = in.polys(Role::room);
        append(space, doorways);
    } else {
        std::vector<Line> closed = blocking.lines;  // everything shut, to tell inside
        for (const Role r : {Role::door, Role::window, Role::opening}) {
            closed.insert(closed.end(), in.line(r).begin(), in.line(r).end());
        }
        space = enclosed(closed);
    }
    std::vector<Polygon> taken = solid_walls;
    append(taken, obstacles);
    const std::vector<Polygon> free =
        standable(planar::subtract(planar::unite(space, snap), taken, snap), blocking.lines, snap,
                  options.stand_radius_m);
    site.buildings = static_cast<std::int64_t>(
        in.polys(Role::room).empty() ? free.size() : in.polys(Role::room).size());
    site.area_m2 = planar::area_m2(free);

    const planar::Region standing(free);
    const planar::Region solid(taken);
    std::vector<Wall> walls = walls_from_lines(blocking, snap, site.counts);
    std::vector<Line> wall_lines;
    for (const Wall& wall : walls) wall_lines.push_back({wall.a, wall.b});
    const planar::LineIndex index(wall_lines);
    Box box;
    for (Wall& wall : walls) {
        const Vec2d e = (wall.b - wall.a).normalized();
        const Vec2d to_left(-e.y(), e.x());
        const Vec2d middle = (wall.a + wall.b) / 2;
        const auto solid_beside = [&](double sign) {
            return solid.contains(middle + sign * beside_line_m / 2 * to_left);
        };
        const bool thick = solid_beside(1) || solid_beside(-1);
        // Doubled walls may run closer than we look: nothing may stand between.
        const auto open = [&](const Vec2d& p) {
            const Vec2d from = middle + (p - middle) * 1e-3;
            for (const std::size_t i : index.near((from + p) / 2, (p - from).norm() / 2)) {
                if (separates(wall_lines[i], from, p)) return false;
            }
            return standing.contains(p);
        };
        const auto is_free = [&](double sign) {
            return open(middle + sign * beside_line_m * to_left) ||
                   (thick && !solid_beside(sign) && open(middle + sign * beside_solid_m * to_left));
        };
        wall.free_side[left] = is_free(1);
        wall.free_side[right] = is_free(-1);
        wall.scanned = wall.cls != WallClass::obstacle &&
                       !(wall.cls == WallClass::window && options.windows == WindowMode::ignore);
        if (solid_beside(1) && solid_beside(-1)) {
            ++site.counts.inside_solids;
            continue;
        }
        box.add(wall.a);
        box.add(wall.b);
        site.walls.push_back(wall);
    }
    sort_walls(site.walls);
    site.extent = box;
    for (const Polygon& p : free) {
        site.free_region.push_back(p.outer);
        for (const Ring& hole : p.holes) site.free_region.push_back(hole);
    }
}

}  // namespace vfplan
