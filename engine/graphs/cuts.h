// Where a graph would fall apart.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graphs/graph.h"

namespace vfplan {

// Bridges (edges whose loss parts a component), articulation nodes (the same of nodes), and which
// nodes lie on a cycle. `lesser_part`: of what would remain of a node's component without the node,
// the size of the second largest part; 0 where it stays whole. `block`: a number for each set of
// nodes that hang together without any bridge.
struct Cuts {
    std::int64_t bridges = 0;
    std::vector<std::uint8_t> articulation;
    std::vector<std::uint8_t> on_cycle;
    std::vector<std::int32_t> lesser_part;
    std::vector<std::int32_t> block;
};
// Two edges between two nodes are a cycle. Time O(nodes + edges). Thread-safe.
Cuts find_cuts(const Graph& graph);

}  // namespace vfplan
