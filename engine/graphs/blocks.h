// What no single node's loss divides.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/index.h"

namespace vfplan {

// The largest parts of a graph that hang together whatever single node is lost, of two nodes or
// more (a link that is the only way between its sides is one). Two of them have one node in common
// at most. In an order that follows from the graph; a node alone is in none.
struct NodeBlocks {
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int32_t> node;

    std::int32_t size() const { return static_cast<std::int32_t>(begin.size()) - 1; }
    std::span<const std::int32_t> of(std::int32_t block) const {
        return {node.data() + begin[idx(block)], node.data() + begin[idx(block) + 1]};
    }
};

// Neighbours of each node as compressed sparse rows; no parallel links. `parts`, where asked for:
// in how many the graph falls. Time O(nodes + links). Thread-safe.
NodeBlocks find_blocks(std::span<const std::int64_t> begin, std::span<const std::int32_t> to,
                       std::int32_t* parts = nullptr);

}  // namespace vfplan
