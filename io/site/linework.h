// The linework of a site on its way to walls: pieces of polygons' rings and of lines, each with
// what it is and where it is from.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/features/feature.h"
#include "kernels/faces.h"
#include "kernels/noding.h"

namespace vfplan {

// Kinds of areas (kernels/faces.h).
inline constexpr AreaKind solid_area = 0;     // walls and buildings: nobody sees through them
inline constexpr AreaKind obstacle_area = 1;  // in the way too
inline constexpr AreaKind outline_area = 2;   // free ground, and its border is a wall
inline constexpr AreaKind room_area = 3;
inline constexpr AreaKind doorway_area = 4;
inline constexpr AreaKind opened_area = 5;  // an open door or window: no wall stands in it
inline constexpr AreaKind window_area = 6;  // the part of a wall that a window takes up

constexpr Kinds bit(AreaKind kind) { return static_cast<Kinds>(1U << static_cast<unsigned>(kind)); }
// Whether nobody can be in an area: something solid is, and no opening leads through it.
constexpr bool is_taken(Kinds kinds) {
    const bool solid = (kinds & (bit(solid_area) | bit(window_area))) != 0;
    return (kinds & bit(obstacle_area)) != 0 || (solid && (kinds & bit(opened_area)) == 0);
}

// What a polygon or a line is.
struct Source {
    AreaKind kind = line_kind;
    std::optional<WallClass> cls;  // none: it parts the ground but is no wall
    bool shut = false;             // no wall, but it keeps the outside out
};

class Linework {
public:
    explicit Linework(double snap_m) : snap_m_(snap_m) {}

    void add(const Polygon& polygon, const Source& source);
    // The line's ends are not joined.
    void add(const Line& line, const Source& source);
    // A piece between two places of the lattice, and its label.
    std::int32_t add(const LatticePoint& a, const LatticePoint& b, const Source& source);

    // The same with a label that is there already.
    void add(const LatticePoint& a, const LatticePoint& b, std::int32_t label);

    double snap_m() const { return snap_m_; }
    const std::vector<LabelledSegment>& segments() const { return segments_; }
    // By label; a polygon has one for all of its rings.
    const std::vector<Source>& sources() const { return sources_; }

private:
    void add_points(const std::vector<Vec2d>& points, bool closed);

    double snap_m_;
    std::vector<LabelledSegment> segments_;
    std::vector<Source> sources_;
};

}  // namespace vfplan
