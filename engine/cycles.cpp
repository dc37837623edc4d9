#include "engine/cycles.h"

#include <cassert>
#include <utility>

namespace vfplan {

Cycles::Cycles(const Graph& graph)
    : graph_(graph),
      above_(at(graph.size()), outside),
      depth_(at(graph.size()), 0),
      drawn_(at(graph.size()), nothing),
      closed_(at(graph.size()), 0) {}

std::int32_t Cycles::top(std::int32_t node) {
    while (drawn_[at(node)] != node) {
        node = drawn_[at(node)] = drawn_[at(drawn_[at(node)])];
    }
    return node;
}

// The way between the two in the forest, and the link between them: a cycle.
void Cycles::close(std::int32_t a, std::int32_t b) {
    a = top(a);
    b = top(b);
    while (a != b) {
        if (depth_[at(a)] < depth_[at(b)]) std::swap(a, b);
        assert(above_[at(a)] >= 0);
        const std::int32_t up = top(above_[at(a)]);
        drawn_[at(a)] = up;
        closed_[at(up)] = 1;
        a = up;
    }
}

void Cycles::add(std::int32_t node) {
    assert(!inside(node));
    above_[at(node)] = nothing;
    depth_[at(node)] = 0;
    drawn_[at(node)] = node;
    graph_.each(node, [&](std::int32_t n, double) {
        if (!inside(n)) return;
        if (above_[at(node)] == nothing) {
            above_[at(node)] = n;
            depth_[at(node)] = depth_[at(n)] + 1;
        } else {
            close(node, n);
        }
    });
}

void Cycles::add_network(const std::vector<std::int32_t>& nodes) {
    for (const std::int32_t v : nodes) above_[at(v)] = waiting;
    std::vector<std::int32_t> queue;
    for (const std::int32_t seed : nodes) {
        if (above_[at(seed)] != waiting) continue;
        above_[at(seed)] = outside;
        queue.assign(1, seed);
        for (std::size_t i = 0; i < queue.size(); ++i) {
            graph_.each(queue[i], [&](std::int32_t n, double) {
                if (above_[at(n)] != waiting) return;
                above_[at(n)] = outside;
                queue.push_back(n);
            });
            add(queue[i]);
        }
    }
}

}  // namespace vfplan
