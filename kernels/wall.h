// Walls and the site they enclose (docs/method.md 1), the common input of every kernel.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/names.h"
#include "kernels/vec.h"

namespace vfplan {

enum class WallClass : std::uint8_t { wall = 0, window = 1, door = 2, obstacle = 3 };
template <>
struct Names<WallClass> {
    static constexpr std::array<std::string_view, 4> all = {"wall", "window", "door", "obstacle"};
};

// The two faces of a wall a -> b.
enum Side : std::uint8_t { left = 0, right = 1 };

// One straight edge. Walls of one site meet at end points only.
struct Wall {
    Vec2d a;
    Vec2d b;
    WallClass cls = WallClass::wall;
    bool scanned = true;               // false: occludes, but nobody has to observe it
    bool free_side[2] = {true, true};  // whether a station could stand before that side

    double length_m() const { return (b - a).norm(); }
    Vec2d at(double s_m) const { return a + (b - a) * (s_m / length_m()); }
};

// A closed ring; the first point is not repeated.
using Ring = std::vector<Vec2d>;

// What was done to the input, in counts of what it was done to.
struct CleaningCounts {
    std::int64_t features = 0;  // features read
    std::int64_t ignored = 0;   // features of a class or geometry that makes no wall
    std::int64_t repaired = 0;  // invalid polygons made valid (site.invalid = "repair")
    std::int64_t dropped_invalid =
        0;                           // polygons without area, or invalid with site.invalid = "drop"
    std::int64_t outside_crop = 0;   // features left out by crop_m
    std::int64_t edges_in = 0;       // edges before cleaning
    std::int64_t zero_length = 0;    // edges shorter than the snap
    std::int64_t duplicates = 0;     // edges that lay on another edge
    std::int64_t split = 0;          // extra edges made where edges cross or touch
    std::int64_t merged = 0;         // edges joined to a collinear neighbour
    std::int64_t inside_solids = 0;  // edges dropped because both sides are solid
    std::int64_t walls = 0;          // walls in the end

    CleaningCounts& operator+=(const CleaningCounts& o) {
        features += o.features;
        ignored += o.ignored;
        repaired += o.repaired;
        dropped_invalid += o.dropped_invalid;
        outside_crop += o.outside_crop;
        edges_in += o.edges_in;
        zero_length += o.zero_length;
        duplicates += o.duplicates;
        split += o.split;
        merged += o.merged;
        inside_solids += o.inside_solids;
        walls += o.walls;
        return *this;
    }
};

// A cleaned site. Coordinates are metres in the site's frame: input coordinates minus `origin`
// (whole metres, so that the subtraction loses nothing that the snap would keep).
struct Site {
    Vec2d origin{0, 0};
    std::vector<Wall> walls;
    std::vector<Ring> free_region;  // even-odd: a point inside an odd number of rings is free
    Box extent;                     // what the grid covers
    std::int64_t buildings = 0;     // solid polygons (outdoor) or named rooms / faces (indoor)
    double area_m2 = 0;             // built area (outdoor) or floor area (indoor)
    std::string crs_wkt;            // empty when the input has none
    CleaningCounts counts;
};

}  // namespace vfplan
