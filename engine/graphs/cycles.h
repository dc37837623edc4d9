// Which nodes of a growing network lie on a cycle.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graphs/graph.h"

namespace vfplan {

// A forest over the nodes inside; a link that the forest does without closes a cycle, and whatever
// it closes is drawn together into one. So all growing together costs little more than its links.
class Cycles {
public:
    // With no node inside. Refers to the graph, which has no parallel edges.
    explicit Cycles(const Graph& graph);

    bool inside(std::int32_t node) const { return above_[idx(node)] >= nothing; }
    // Adds a node with its links to those inside.
    // REQUIRES: those are joined with each other already.
    void add(std::int32_t node);
    // Adds a whole network at once.
    void add_network(const std::vector<std::int32_t>& nodes);
    bool on_cycle(std::int32_t node) { return closed_[idx(top(node))] != 0; }

private:
    static constexpr std::int32_t nothing = -1;
    static constexpr std::int32_t outside = -2;
    static constexpr std::int32_t waiting = -3;  // outside, about to be added

    std::int32_t top(std::int32_t node);
    void close(std::int32_t a, std::int32_t b);

    const Graph& graph_;
    std::vector<std::int32_t> above_;  // in the forest; `nothing` at a root
    std::vector<std::int32_t> depth_;  // in the forest
    std::vector<std::int32_t> drawn_;  // towards the topmost node of what it is drawn together with
    std::vector<std::uint8_t> closed_;  // topmost node of more than one
};

}  // namespace vfplan
