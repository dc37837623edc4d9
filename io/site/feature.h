// What a vector file holds, free of any library's types.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kernels/vec.h"
#include "kernels/wall.h"

namespace vfplan {

using Line = std::vector<Vec2d>;

// Rings without the repeated last point.
struct Polygon {
    Ring outer;
    std::vector<Ring> holes;
};

// What a feature means for a site.
enum class Role : std::uint8_t {
    building,  // outdoor solid
    wall,
    window,
    door,
    obstacle,  // stands in the way, need not be scanned
    room,      // a space that people call a room; no wall
    outline,   // the free space itself; its rings are walls
    opening,   // leaves, swings, panes, sills of a drawing: no wall, but they close the outline
    drawing,   // labels, dimensions, hatches: nothing
};

struct Feature {
    std::int64_t number = 0;  // 1 for the first of its layer
    std::string id;           // the source's own name for it, may be empty
    Role role = Role::building;
    std::vector<Polygon> polygons;
    std::vector<Line> lines;
};

// Calls change(point) for every point of a feature.
template <class F>
void each_point(Feature& feature, F&& change) {
    for (Polygon& p : feature.polygons) {
        for (Vec2d& v : p.outer) change(v);
        for (Ring& hole : p.holes) {
            for (Vec2d& v : hole) change(v);
        }
    }
    for (Line& line : feature.lines) {
        for (Vec2d& v : line) change(v);
    }
}

// The geometries of features by role.
struct FeaturesByRole {
    std::array<std::vector<Polygon>, 9> polygons;
    std::array<std::vector<Line>, 9> lines;
    const std::vector<Polygon>& polys(Role r) const {
        return polygons[static_cast<std::size_t>(r)];
    }
    const std::vector<Line>& line(Role r) const { return lines[static_cast<std::size_t>(r)]; }
};

// All that was read from one file.
struct FeatureSet {
    std::vector<Feature> features;
    std::string crs_wkt;       // empty when unknown
    std::int64_t ignored = 0;  // points, empty geometries, features that are no building
    std::vector<std::string> warnings;
};

}  // namespace vfplan
