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

// Solids united and lines beside them, on a grid of `snap_m`, as GEOS makes them: what verify holds
// a site against.
class Drawn {
public:
    // Polygons that cross themselves count as make_valid has them.
    Drawn(const std::vector<Polygon>& solids, const std::vector<Line>& lines, double snap_m);
    ~Drawn();
    Drawn(const Drawn&) = delete;
    Drawn& operator=(const Drawn&) = delete;

    double wall_length_m()
        const;  // the solids' border, and the lines outside them, each stretch once
    bool solid(const Vec2d& p) const;  // strictly inside; one thread at a time

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vfplan::planar
