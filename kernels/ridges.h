// Joints and ridges of a skeleton (docs/method.md 3).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/grid.h"

namespace vfplan {

// The cells of a skeleton, ascending, with the squared distance in cells of each to the domain's
// edge. A county's skeleton fits in memory where its grid does not.
struct SkeletonCells {
    std::vector<std::int64_t> cell;
    std::vector<std::int32_t> squared;
};

// A skeleton line without branches. `cells` run from one end to the other.
struct Ridge {
    std::vector<std::int64_t> cells;
    std::int32_t joint[2] = {-1, -1};  // the joint before the first and behind the last cell
    bool ring = false;                 // closed, without any joint
};

// Joint: an 8-connected cluster of skeleton cells that have three or more skeleton neighbours,
// represented by its cell nearest to the centroid (ties: row, then column).
struct RidgeGraph {
    std::vector<std::int64_t> joints;  // representative cells, by cluster in order of first cell
    std::vector<Ridge> ridges;         // in order of their first cell
};

// Takes a skeleton apart. Time O(cells). Thread-safe.
RidgeGraph ridge_graph(const Grid& grid, const SkeletonCells& skeleton);

// Removes spurs: ridges with one free end that are shorter than the clearance (distance to the
// domain's edge) at their joint; repeated until none is left. Returns the number of spurs.
std::int64_t prune_spurs(const Grid& grid, SkeletonCells& skeleton);

// Length in cells along cells[from..to], steps of 1 and sqrt(2).
double arc_cells(const Grid& grid, const std::vector<std::int64_t>& cells, std::size_t from,
                 std::size_t to);

// Index of the cell nearest to the middle of the arc between two indices, strictly between them.
// REQUIRES: to >= from + 2.
std::size_t arc_middle(const Grid& grid, const std::vector<std::int64_t>& cells, std::size_t from,
                       std::size_t to);

}  // namespace vfplan
