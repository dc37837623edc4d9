// What no single node's loss divides.
#pragma once

#include <cstdint>

#include "engine/graphs/sparse.h"

namespace vfplan {

// The largest parts of a graph that hang together whatever single node is lost, of two nodes or
// more (a link that is the only way between its sides is one): the nodes of each, in an order that
// follows from the graph. Two of them have one node in common at most; a node alone is in none.
// `near`: the neighbours of each node; no parallel links. `parts`, where asked for: in how many the
// graph falls. Time O(nodes + links). Thread-safe.
Sparse find_blocks(const Sparse& near, std::int32_t* parts = nullptr);

}  // namespace vfplan
