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

// A straight piece of the border of an area.
struct Border {
    Vec2d a;
    Vec2d b;
};
inline std::vector<Border> border_of(const std::vector<Ring>& rings) {
    std::vector<Border> border;
    for (const Ring& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            border.push_back({ring[i], ring[(i + 1) % ring.size()]});
        }
    }
    return border;
}

// What was done to the input, in counts of what it was done to.
struct CleaningCounts {
    std::int64_t features = 0;  // features read
    std::int64_t ignored = 0;   // features of a class or geometry that makes no wall
    std::int64_t repaired = 0;  // polygons that cross themselves, read as what they surround
    std::int64_t dropped_invalid =
        0;                           // polygons without area, or invalid with site.invalid = "drop"
    std::int64_t outside_crop = 0;   // features left out by crop_m
    std::int64_t edges_in = 0;       // edges before cleaning
    std::int64_t zero_length = 0;    // edges shorter than the snap
    std::int64_t duplicates = 0;     // edges that lay on another edge
    std::int64_t split = 0;          // extra edges made where edges cross or touch
    std::int64_t merged = 0;         // edges joined to a collinear neighbour
    std::int64_t inside_solids = 0;  // edges dropped because both sides are solid
    std::int64_t opened = 0;         // edges dropped because a door or window opens them
    std::int64_t slivers = 0;        // edges dropped that areas thinner than the snap leave
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
        opened += o.opened;
        slivers += o.slivers;
        walls += o.walls;
        return *this;
    }
};

// Why ground inside a building is none for stations.
enum class DropReason : std::uint8_t { narrow = 0, unnamed = 1 };
template <>
struct Names<DropReason> {
    static constexpr std::array<std::string_view, 2> all = {"narrow", "unnamed"};
};

// A part of the inside that is no ground, or whose walls' faces nobody can see from the ground.
struct Dropped {
    Vec2d at;  // a place in it
    DropReason why = DropReason::narrow;
    double area_m2 = 0;
    double faces_m = 0;  // length of faces around it that need no scan, each wall's side for itself
};

// A cleaned site. Coordinates are metres in the site's frame: input coordinates minus `origin`
// (whole metres, so that the subtraction loses nothing that the snap would keep).
struct Site {
    Vec2d origin{0, 0};
    std::vector<Wall> walls;
    std::vector<Border> free_border;  // even-odd: what an odd number of times is surrounded is free
    Box extent;                       // what the grid covers
    std::int64_t buildings = 0;       // solid polygons (outdoor) or named rooms / spaces (indoor)
    double area_m2 = 0;               // built area (outdoor) or floor area (indoor)
    std::vector<Border> left_out_border;  // even-odd: inside a building, but no ground
    std::vector<Dropped> dropped;         // indoors, the largest first
    std::vector<Vec2d> required;          // the user's points, in this frame
    std::vector<Vec2d> existing;
    std::vector<Vec2d> repaired_at;  // a place each where a polygon crosses itself
    std::string crs_wkt;             // empty when the input has none
    CleaningCounts counts;
};

}  // namespace vfplan
