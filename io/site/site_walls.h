// Walls from linework: noded, classified, joined and put in order.
#pragma once

#include <vector>

#include "io/site/feature.h"
#include "kernels/wall.h"

namespace vfplan {

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

}  // namespace vfplan
