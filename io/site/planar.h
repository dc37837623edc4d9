// The door to GEOS: what is asked of polygons and lines that the subdivision of a site does not
// tell. Thread-safe.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/features/feature.h"

namespace vfplan::planar {

// Why a polygon is invalid, with the place; empty for a valid one.
std::string invalid_reason(const Polygon& polygon);

// Radius of the largest circle that fits into what the lines surround, to within `tolerance`.
double inscribed_radius(const std::vector<Line>& border, double tolerance);

// What is drawn, by what it does to walls.
struct Parts {
    std::vector<Polygon> solids;
    std::vector<Polygon> openings;  // doors and windows that stand open: they open solids and lines
    std::vector<Polygon> obstacles;  // solid in openings too
    std::vector<Polygon> outlines;   // free ground; their rings are walls
    std::vector<Line> lines;
};

// Parts united on a grid of `snap_m`, as GEOS makes them: what verify holds a site against.
class Drawn {
public:
    // Polygons that cross themselves count as make_valid has them.
    Drawn(const Parts& parts, double snap_m);
    ~Drawn();
    Drawn(const Drawn&) = delete;
    Drawn& operator=(const Drawn&) = delete;

    double border_m() const;  // of all that is solid
    double lines_m() const;   // lines and outlines beside it, each stretch once
    double solid_m2() const;
    double outlined_m2() const;  // within outlines, without what is solid
    bool has_outlines() const;
    // Strictly inside; one thread at a time.
    bool solid(const Vec2d& p) const;
    bool outlined(const Vec2d& p) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vfplan::planar
