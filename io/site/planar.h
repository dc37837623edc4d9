// The door to GEOS: overlays of polygons and lines on a fixed grid of coordinates.
//
// Everything that returns linework has its points on multiples of `snap_m` (snap rounding), so
// equal input gives equal bits and no two results cross. Not thread-safe across one call; calls
// are independent of each other.
#pragma once

#include <string>
#include <vector>

#include "io/site/feature.h"

namespace vfplan::planar {

// Why a polygon is invalid, with the place; empty for a valid one.
std::string invalid_reason(const Polygon& polygon);

// The valid polygons that an invalid one covers.
std::vector<Polygon> repaired(const Polygon& polygon);

Box bounds(const Line& points);

std::vector<Polygon> unite(const std::vector<Polygon>& polygons, double snap_m);
std::vector<Polygon> subtract(const std::vector<Polygon>& from, const std::vector<Polygon>& what,
                              double snap_m);

std::vector<Polygon> intersect(const std::vector<Polygon>& a, const std::vector<Polygon>& b,
                               double snap_m);

// Grows (or shrinks, distance < 0) with mitred corners, so that right angles stay.
std::vector<Polygon> grow(const std::vector<Polygon>& polygons, double distance_m);

// Strips of half-width `distance_m` around lines; flat: ending where the line ends.
std::vector<Polygon> strips(const std::vector<Line>& lines, double distance_m, bool flat);

// Splits lines at every crossing and touch, drops repeated stretches.
std::vector<Line> node(const std::vector<Line>& lines, double snap_m);

// Radius of the largest circle that fits into what the lines surround, to within `tolerance`.
double inscribed_radius(const std::vector<Line>& border, double tolerance);

double area_m2(const std::vector<Polygon>& polygons);

// Fast repeated point tests.
class Region {
public:
    explicit Region(const std::vector<Polygon>& polygons);
    ~Region();
    Region(const Region&) = delete;
    Region& operator=(const Region&) = delete;
    bool contains(const Vec2d& point) const;  // strictly inside

private:
    struct Impl;
    Impl* impl_;
};

// Which of many lines pass near a point.
class LineIndex {
public:
    explicit LineIndex(const std::vector<Line>& lines);
    ~LineIndex();
    LineIndex(const LineIndex&) = delete;
    LineIndex& operator=(const LineIndex&) = delete;
    // Indices of lines within `distance_m`, ascending.
    std::vector<std::size_t> near(const Vec2d& point, double distance_m) const;

private:
    struct Impl;
    Impl* impl_;
};

}  // namespace vfplan::planar
