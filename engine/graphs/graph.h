// Undirected graphs with an overlap on each edge: of candidates, or of stations.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/index.h"

namespace vfplan {

// Neighbours ascending, as compressed sparse rows; no parallel edges.
struct Graph {
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int32_t> to;
    std::vector<double> overlap;

    std::int32_t size() const { return static_cast<std::int32_t>(begin.size()) - 1; }
    std::int64_t edges() const { return static_cast<std::int64_t>(to.size()) / 2; }
    // Calls f(neighbour, overlap).
    template <class F>
    void each(std::int32_t v, F&& f) const {
        for (auto i = idx(begin[idx(v)]); i < idx(begin[idx(v) + 1]); ++i) f(to[i], overlap[i]);
    }
};

// Two nodes and their overlap, from < to.
struct OverlapPair {
    std::int32_t from = 0;
    std::int32_t to = 0;
    double overlap = 0;
};

// REQUIRES: pairs ascend in (from, to).
Graph make_graph(std::int32_t nodes, const std::vector<OverlapPair>& pairs);

// The part of a graph between `nodes` (ascending), renumbered by position.
Graph induced(const Graph& graph, const std::vector<std::int32_t>& nodes);

// Number of the connected component of each node, numbered by their first node.
std::vector<std::int32_t> components(const Graph& graph);

}  // namespace vfplan
