// From a file's features to a cleaned site: walls that meet at their ends only, with their free
// sides, and the region where stations may stand (SPEC section 1).
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/feature.h"
#include "io/roles.h"
#include "kernels/wall.h"

namespace vfplan {

enum class InvalidPolygons : std::uint8_t { error, repair, drop };
enum class WindowMode : std::uint8_t { wall, ignore, opening };

struct SiteOptions {
    SiteKind kind = SiteKind::outdoor;
    std::string layer;
    std::string crs;
    double unit_m = 1;
    double snap_m = 0.001;
    double margin_m = 0;         // free ground around the outermost walls (outdoor)
    std::vector<double> crop_m;  // empty or x0, y0, x1, y1 in the file's own metres
    bool doors_open = true;
    WindowMode windows = WindowMode::wall;
    InvalidPolygons invalid = InvalidPolygons::error;
    double stand_radius_m = 0.3;  // indoors: a space is a room when such a circle fits in
    // Calls body(from, to) for disjoint parts of [0, n), perhaps several at once.
    using Body = std::function<void(std::int64_t, std::int64_t)>;
    std::function<void(std::int64_t n, const Body& body)> for_each =
        [](std::int64_t n, const Body& body) { body(0, n); };
};

struct SiteResult {
    Site site;
    std::vector<std::string> warnings;
};

// Reads and cleans. Throws as read_features() does, and InputError for an invalid polygon (by
// its feature, reason and place), for no walls, and for no free space.
SiteResult read_site(const std::filesystem::path& file, const SiteOptions& options);

// The same from features in memory; `name` is used in messages.
SiteResult build_site(FeatureSet set, const SiteOptions& options, const std::string& name);

// The rings of the union of polygons, for even-odd tests.
std::vector<Ring> rings_of_union(const std::vector<Polygon>& polygons, double snap_m);

// --- the parts, for site_outdoor.cpp and site_indoor.cpp -------------------------------------

// The features by role, valid, in the site's frame.
struct Sorted {
    std::array<std::vector<Polygon>, 9> polygons;  // by Role
    std::array<std::vector<Line>, 9> lines;
    const std::vector<Polygon>& polys(Role r) const {
        return polygons[static_cast<std::size_t>(r)];
    }
    const std::vector<Line>& line(Role r) const { return lines[static_cast<std::size_t>(r)]; }
};

// Linework that blocks sight, before noding.
struct Blocking {
    std::vector<Line> lines;
    std::vector<WallClass> cls;

    void add(const std::vector<Line>& more, WallClass c);
    void add_rings(const std::vector<Polygon>& polygons, WallClass c);
};

// Nodes the lines, gives every stretch the class of the line it lies on (wall before window before
// door before obstacle), joins collinear neighbours of one class, counts what happened.
// Free sides are left at true. Walls come in no order that means anything (see sort_walls()).
std::vector<Wall> walls_from_lines(const Blocking& blocking, double snap_m, CleaningCounts& counts);

// By square of 256 m, then by their ends: walls near each other have near numbers.
void sort_walls(std::vector<Wall>& walls);

void build_outdoor(const Sorted& in, const SiteOptions& options, Site& site);
void build_indoor(const Sorted& in, const SiteOptions& options, Site& site);

}  // namespace vfplan
