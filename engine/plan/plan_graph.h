// The stations of a plan and their links as a graph.
#pragma once

#include <vector>

#include "engine/graphs/graph.h"
#include "kernels/candidate.h"

namespace vfplan {

Graph graph_of(const Plan& plan);

// For each network the tree of links whose weakest is strongest, all of them with the highest
// overlap first (ties: as the plan has them).
std::vector<Link> strongest_tree(const Plan& plan);

}  // namespace vfplan
