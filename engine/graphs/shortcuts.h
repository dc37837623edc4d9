// Nodes that make the ways through a chosen part of a graph shorter.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graphs/graph.h"

namespace vfplan {

// Parts with more nodes get no shortcuts: memory and time go with the square.
inline constexpr std::size_t shortened_most = 2000;

// Up to `most` nodes beside the `chosen` ones (ascending, at least two, which hang together), one
// after the other, as they were taken: each, of those that save most between two of their
// neighbours, the one that makes the ways between all that are chosen by then shortest, in the
// mean. A way's length is the sum of 1 - overlap over its links (method.md, equation 13). Ends
// where none makes one shorter. Follows from its arguments alone. Thread-safe.
std::vector<std::int32_t> shortcuts(const Graph& graph, const std::vector<std::int32_t>& chosen,
                                    std::int64_t most);

}  // namespace vfplan
