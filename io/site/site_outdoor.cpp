#include "io/site/site_outdoor.h"

#include "io/site/groups.h"
#include "io/site/subdivision.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr Source solid_wall{solid_area, WallClass::wall};
constexpr Source solid_obstacle{obstacle_area, WallClass::obstacle};
constexpr Source fence{line_kind, WallClass::wall};
constexpr Source obstacle_line{line_kind, WallClass::obstacle};

// What a part of the site that touches nothing else of it becomes.
struct Built {
    std::vector<Wall> walls;
    double area_m2 = 0;
    std::vector<Vec2d> repaired_at;
    CleaningCounts counts;
};

// Polygons and lines in a row, so that they can be numbered together.
class Items {
public:
    explicit Items(const FeaturesByRole& in) {
        for (const Role r : {Role::building, Role::wall, Role::window, Role::door, Role::outline}) {
            for (const Polygon& p : in.polys(r)) add(p, solid_wall);
        }
        solids_ = boxes_.size();
        for (const Polygon& p : in.polys(Role::obstacle)) add(p, solid_obstacle);
        for (const Line& line : in.line(Role::wall)) add(line, fence);
        for (const Line& line : in.line(Role::obstacle)) add(line, obstacle_line);
    }

    const std::vector<Box>& boxes() const { return boxes_; }
    std::size_t solids() const { return solids_; }
    Linework linework(const std::vector<std::size_t>& members, double snap_m) const {
        Linework out(snap_m);
        for (const std::size_t i : members) {
            if (polygon_[i] != nullptr) {
                out.add(*polygon_[i], source_[i]);
            } else {
                out.add(*line_[i], source_[i]);
            }
        }
        return out;
    }

private:
    void add(const Polygon& polygon, const Source& source) {
        Box box;
        for (const Vec2d& v : polygon.outer) box.add(v);
        for (const Ring& hole : polygon.holes) {
            for (const Vec2d& v : hole) box.add(v);  // a wrong one may reach beyond
        }
        boxes_.push_back(box);
        polygon_.push_back(&polygon);
        line_.push_back(nullptr);
        source_.push_back(source);
    }
    void add(const Line& line, const Source& source) {
        Box box;
        for (const Vec2d& v : line) box.add(v);
        boxes_.push_back(box);
        polygon_.push_back(nullptr);
        line_.push_back(&line);
        source_.push_back(source);
    }

    std::vector<Box> boxes_;
    std::vector<const Polygon*> polygon_;
    std::vector<const Line*> line_;
    std::vector<Source> source_;
    std::size_t solids_ = 0;
};

Built build_group(const Linework& linework) {
    const Subdivision s = subdivide(linework);
    Built out;
    count_edges(linework, s.noded, out.counts);
    out.repaired_at = self_crossings(linework, s.noded);
    std::vector<EdgeUse> use = walls_among(s, out.counts);
    for (std::size_t e = 0; e < use.size(); ++e) {
        for (const Side side : {left, right}) {
            use[e].free[side] = s.kinds[idx(s.triangle_at[e][side])] == 0;
        }
    }
    out.walls = walls_of(s, linework.snap_m(), use, out.counts);
    out.area_m2 = area_m2(s, linework.snap_m(),
                          [&](std::int32_t triangle) { return s.kinds[idx(triangle)] != 0; });
    return out;
}

}  // namespace

void build_outdoor(const FeaturesByRole& in, const SiteOptions& options, Site& site) {
    const Items items(in);
    site.buildings = static_cast<std::int64_t>(items.solids());
    const auto groups = neighbour_groups(items.boxes(), 4 * options.snap_m);
    std::vector<Built> built(groups.size());
    options.for_each(
        static_cast<std::int64_t>(groups.size()), [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t g = from; g < to; ++g) {
                built[idx(g)] = build_group(items.linework(groups[idx(g)], options.snap_m));
            }
        });
    Box box;
    for (Built& b : built) {
        site.area_m2 += b.area_m2;
        site.counts += b.counts;
        site.repaired_at.insert(site.repaired_at.end(), b.repaired_at.begin(), b.repaired_at.end());
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
    // Inside a frame around the extent, what no solid takes is free.
    const Vec2d lo = site.extent.min - Vec2d(1, 1);
    const Vec2d hi = site.extent.max + Vec2d(1, 1);
    site.free_border = border_of({{lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}}});
    for (const Wall& wall : site.walls) {
        if (wall.free_side[left] != wall.free_side[right]) {
            site.free_border.push_back({wall.a, wall.b});
        }
    }
}

}  // namespace vfplan
