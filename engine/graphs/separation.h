// What one node means to the connection of a chosen set of nodes, found by looking around it only.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graphs/graph.h"

namespace vfplan {

// Searches outward from all neighbours of a node at once, step by step, so that an answer costs
// about as much as the smaller sides hold: a few nodes in most networks, where the cuts of the
// whole network would cost its size every time. Not thread-safe.
class Separation {
public:
    // `inside`: by node, 1 for the chosen ones. Refers to the graph, which has no parallel edges.
    Separation(const Graph& graph, std::vector<std::uint8_t> inside);
    // With no node chosen yet.
    explicit Separation(const Graph& graph);

    bool inside(std::int32_t node) const { return inside_[static_cast<std::size_t>(node)] != 0; }
    void add(std::int32_t node) { inside_[static_cast<std::size_t>(node)] = 1; }
    void remove(std::int32_t node) { inside_[static_cast<std::size_t>(node)] = 0; }

    // True when the chosen neighbours of `node` stay connected with each other without it.
    bool can_go(std::int32_t node);
    // Nodes looked around from so far.
    std::int64_t steps() const { return steps_; }

private:
    // One of the neighbours' searches, or several that have met.
    struct Side {
        std::vector<std::int32_t> queue;
        std::size_t next = 0;
        std::size_t joined_to = 0;  // itself, or the side that it met
    };

    std::size_t root(std::size_t side) const;
    void step(std::size_t side, std::int32_t without);
    bool finished(std::size_t side) const;

    const Graph& graph_;
    std::vector<std::uint8_t> inside_;
    std::vector<std::int32_t> side_of_;  // of the current search; -1 outside it
    std::vector<Side> sides_;
    std::int64_t steps_ = 0;
    std::size_t apart_ = 0;  // sides that have not met another yet, roots
};

}  // namespace vfplan
