#include "io/site/site_outdoor.h"

#include "io/site/planar.h"
#include "io/site/site_walls.h"

namespace vfplan {
namespace {

// A part of the site that touches nothing else of it.
struct Group {
    std::vector<Polygon> solids;
    std::vector<Polygon> obstacles;
    std::vector<Line> walls;
    std::vector<Line> obstacle_lines;
};

// What a group becomes.
struct Built {
    std::vector<Wall> walls;
    std::vector<Polygon> ground;  // solid
    double area_m2 = 0;
    CleaningCounts counts;
};

// Polygons and lines in a row, so that they can be numbered together.
class Items {
public:
    Items(const FeaturesByRole& in, const std::vector<Role>& solid_roles) {
        for (const Role r : solid_roles) add(in.polys(r), 0);
        solids_ = boxes_.size();
        add(in.polys(Role::obstacle), 1);
        for (const Line& line : in.line(Role::wall)) add(line, 2);
        for (const Line& line : in.line(Role::obstacle)) add(line, 3);
    }

    const std::vector<Box>& boxes() const { return boxes_; }
    std::size_t solids() const { return solids_; }
    Group group(const std::vector<std::size_t>& members) const {
        Group out;
        for (const std::size_t i : members) {
            if (kind_[i] < 2) (kind_[i] == 0 ? out.solids : out.obstacles).push_back(*polygon_[i]);
            if (kind_[i] >= 2)
                (kind_[i] == 2 ? out.walls : out.obstacle_lines).push_back(*line_[i]);
        }
        return out;
    }

private:
    void add(const std::vector<Polygon>& polygons, int kind) {
        for (const Polygon& p : polygons) {
            boxes_.push_back(planar::bounds(p.outer));
            polygon_.push_back(&p);
            line_.push_back(nullptr);
            kind_.push_back(kind);
        }
    }
    void add(const Line& line, int kind) {
        boxes_.push_back(planar::bounds(line));
        polygon_.push_back(nullptr);
        line_.push_back(&line);
        kind_.push_back(kind);
    }

    std::vector<Box> boxes_;
    std::vector<const Polygon*> polygon_;
    std::vector<const Line*> line_;
    std::vector<int> kind_;
    std::size_t solids_ = 0;
};

Built build_group(const Group& in, double snap_m) {
    Blocking edges;
    edges.add_rings(in.solids, WallClass::wall);
    edges.add_rings(in.obstacles, WallClass::obstacle);
    edges.add(in.walls, WallClass::wall);
    edges.add(in.obstacle_lines, WallClass::obstacle);
    std::vector<Polygon> solids = in.solids;
    solids.insert(solids.end(), in.obstacles.begin(), in.obstacles.end());
    Built out;
    out.ground = planar::unite(solids, snap_m);
    out.area_m2 = planar::area_m2(out.ground);
    const planar::Region solid(out.ground);
    for (Wall& wall : walls_from_lines(edges, snap_m, out.counts)) {
        const Vec2d e = (wall.b - wall.a).normalized();
        // Nothing else can come nearer than a snap: what lies this close is the wall's own side.
        const Vec2d to_left = snap_m / 4 * Vec2d(-e.y(), e.x());
        const Vec2d middle = (wall.a + wall.b) / 2;
        wall.free_side[left] = !solid.contains(middle + to_left);
        wall.free_side[right] = !solid.contains(middle - to_left);
        wall.scanned = wall.cls != WallClass::obstacle;
        if (wall.free_side[left] || wall.free_side[right]) {
            out.walls.push_back(wall);
        } else {
            ++out.counts.inside_solids;
        }
    }
    return out;
}

}  // namespace

void build_outdoor(const FeaturesByRole& in, const SiteOptions& options, Site& site) {
    const Items items(in, {Role::building, Role::wall, Role::window, Role::door, Role::outline});
    site.buildings = static_cast<std::int64_t>(items.solids());
    const auto groups = planar::neighbour_groups(items.boxes(), 4 * options.snap_m);
    std::vector<Built> built(groups.size());
    options.for_each(
        static_cast<std::int64_t>(groups.size()), [&](std::int64_t from, std::int64_t to) {
            for (auto g = static_cast<std::size_t>(from); g < static_cast<std::size_t>(to); ++g) {
                built[g] = build_group(items.group(groups[g]), options.snap_m);
            }
        });
    Box box;
    for (Built& b : built) {
        site.area_m2 += b.area_m2;
        site.counts += b.counts;
        for (const Wall& wall : b.walls) {
            box.add(wall.a);
            box.add(wall.b);
        }
        site.walls.insert(site.walls.end(), b.walls.begin(), b.walls.end());
        b.walls = {};
    }
    sort_walls(site.walls);
    const Vec2d margin(options.margin_m, options.margin_m);
    site.extent = {box.min - margin, box.max + margin};
    // The frame around the extent, then every solid ring: inside the frame and no solid is free.
    const Vec2d lo = site.extent.min - Vec2d(1, 1);
    const Vec2d hi = site.extent.max + Vec2d(1, 1);
    site.free_region.push_back({lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}});
    for (Built& b : built) {
        for (Polygon& p : b.ground) {
            site.free_region.push_back(std::move(p.outer));
            for (Ring& hole : p.holes) site.free_region.push_back(std::move(hole));
        }
    }
}

}  // namespace vfplan
