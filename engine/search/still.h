// What of a plan stands still while a window changes.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/choosing.h"
#include "engine/search/problem.h"

namespace vfplan {

// Nodes that stand for the stations outside a window, joined by a forest.
struct Still {
    std::vector<std::int32_t> node;  // by column of the whole: of each station outside that a
                                     // column of the window could be linked to; else -1
    std::int32_t nodes = 0;
    std::vector<std::pair<std::int32_t, std::int32_t>> links;  // of the forest, a < b
    // By node, where cycles count.
    std::vector<std::int32_t> block;
    std::vector<std::int32_t> loose;
    std::vector<std::uint8_t> closable;
};

// `inside`: by column, 1 for the window's stations. `touched`: by column, 1 for stations outside
// that a column of the window is near to.
Still find_still(const Problem& whole, const Choosing& plan,
                 const std::vector<std::uint8_t>& inside, const std::vector<std::uint8_t>& touched);

}  // namespace vfplan
