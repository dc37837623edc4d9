// What a vector file holds, free of any library's types.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/names.h"
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
    ignored,   // labels, dimensions, hatches: nothing
};
template <>
struct Names<Role> {
    static constexpr std::array<std::string_view, 9> all = {
        "building", "wall", "window", "door", "obstacle", "room", "outline", "opening", "ignored"};
};

struct Feature {
    std::int64_t number = 0;  // 1 for the first of its layer
    std::string id;           // the source's own name for it, may be empty
    Role role = Role::building;
    std::vector<Polygon> polygons;
    std::vector<Line> lines;
};

// Calls f(point) for every point of a feature, which it may change if the feature is not const.
template <class AnyFeature, class F>
void each_point(AnyFeature& feature, F&& f) {
    for (auto& p : feature.polygons) {
        for (auto& v : p.outer) f(v);
        for (auto& hole : p.holes) {
            for (auto& v : hole) f(v);
        }
    }
    for (auto& line : feature.lines) {
        for (auto& v : line) f(v);
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

// Why features are what they are: those of one layer that say the same.
struct ReadAs {
    std::string layer;
    std::string text;  // the class, type, layer or tag that told; empty: the shape did
    std::string role;  // "left out" for none
    std::string why;   // site.roles, word, tag, shape
    std::int64_t count = 0;
};

// How a file was understood.
struct HowRead {
    std::string format;
    std::string unit;     // of the file, in words
    bool plan = false;    // the format is one of floor plans, whatever is in the file
    bool layers = false;  // options.layer has a meaning for the format
    std::vector<ReadAs> as;
};

// All that was read from one file.
struct FeatureSet {
    std::vector<Feature> features;
    HowRead how;
    std::string crs_wkt;  // empty when unknown
    // From longitude and latitude to these coordinates; empty where the file has no degrees.
    std::function<Vec2d(const Vec2d&)> from_degrees;
    std::int64_t ignored = 0;  // points, empty geometries, features that are no building
    std::vector<std::string> warnings;
};

inline Box bounds(const Feature& feature) {
    Box box;
    each_point(feature, [&](const Vec2d& v) { box.add(v); });
    return box;
}
inline Box bounds(const FeatureSet& set) {
    Box box;
    for (const Feature& f : set.features) each_point(f, [&](const Vec2d& v) { box.add(v); });
    return box;
}

}  // namespace vfplan
