#include "io/planar.h"
#include "io/site_reader.h"

namespace vfplan {
// Polygons are solid, the ground around them is free. Lines (fences, free-standing walls) have
// two free sides, and what of them runs inside a solid is dropped.
void build_outdoor(const Sorted& in, const SiteOptions& options, Site& site) {
    std::vector<Polygon> solids = in.polys(Role::building);
    for (const Role r : {Role::wall, Role::window, Role::door, Role::outline}) {
        solids.insert(solids.end(), in.polys(r).begin(), in.polys(r).end());
    }
    site.buildings = static_cast<std::int64_t>(solids.size());
    Blocking edges;
    edges.add_rings(solids, WallClass::wall);
    edges.add_rings(in.polys(Role::obstacle), WallClass::obstacle);
    edges.add(in.line(Role::wall), WallClass::wall);
    edges.add(in.line(Role::obstacle), WallClass::obstacle);
    solids.insert(solids.end(), in.polys(Role::obstacle).begin(), in.polys(Role::obstacle).end());
    const std::vector<Polygon> ground = planar::unite(solids, options.snap_m);
    site.area_m2 = planar::area_m2(ground);

    std::vector<Wall> walls = walls_from_lines(edges, options.snap_m, site.counts);
    const planar::Region solid(ground);
    Box box;
    for (Wall& wall : walls) {
        const Vec2d e = (wall.b - wall.a).normalized();
        // Nothing else can come nearer than a snap: what lies this close is the wall's own side.
        const Vec2d to_left = options.snap_m / 4 * Vec2d(-e.y(), e.x());
        const Vec2d middle = (wall.a + wall.b) / 2;
        wall.free_side[left] = !solid.contains(middle + to_left);
        wall.free_side[right] = !solid.contains(middle - to_left);
        wall.scanned = wall.cls != WallClass::obstacle;
        if (!wall.free_side[left] && !wall.free_side[right]) {
            ++site.counts.inside_solids;
            continue;
        }
        box.add(wall.a);
        box.add(wall.b);
        site.walls.push_back(wall);
    }
    const Vec2d margin(options.margin_m, options.margin_m);
    site.extent = {box.min - margin, box.max + margin};
    // The frame around the extent, then every solid ring: inside the frame and no solid is free.
    const Vec2d lo = site.extent.min - Vec2d(1, 1);
    const Vec2d hi = site.extent.max + Vec2d(1, 1);
    site.free_region.push_back({lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}});
    for (const Polygon& p : ground) {
        site.free_region.push_back(p.outer);
        for (const Ring& hole : p.holes) site.free_region.push_back(hole);
    }
}

}  // namespace vfplan
