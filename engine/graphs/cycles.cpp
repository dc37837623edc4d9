#include "engine/graphs/cycles.h"

#include <cassert>
#include <utility>

namespace vfplan {

Cycles::Cycles(const Graph& graph)
    : graph_(graph),
      above_(idx(graph.size()), outside),
      depth_(idx(graph.size()), 0),
      drawn_(idx(graph.size()), nothing),
      closed_(idx(graph.size()), 0) {}

std::int32_t Cycles::top(std::int32_t node) {
    while (drawn_[idx(node)] != node) {
        node = drawn_[idx(node)] = drawn_[idx(drawn_[idx(node)])];
    }
    return node;
}

// The path between the two in the forest, and the link between them: a cycle.
void Cycles::close(std::int32_t a, std::int32_t b) {
    a = top(a);
    b = top(b);
    while (a != b) {
        if (depth_[idx(a)] < depth_[idx(b)]) std::swap(a, b);
        assert(above_[idx(a)] >= 0);
        const std::int32_t up = top(above_[idx(a)]);
        drawn_[idx(a)] = up;
        closed_[idx(up)] = 1;
        a = up;
    }
}

void Cycles::add(std::int32_t node) {
    assert(!inside(node));
    above_[idx(node)] = nothing;
    depth_[idx(node)] = 0;
    drawn_[idx(node)] = node;
    graph_.each(node, [&](std::int32_t n, double) {
        if (!inside(n)) return;
        if (above_[idx(node)] == nothing) {
            above_[idx(node)] = n;
            depth_[idx(node)] = depth_[idx(n)] + 1;
        } else {
            close(node, n);
        }
    });
}

void Cycles::add_network(const std::vector<std::int32_t>& nodes) {
    for (const std::int32_t v : nodes) above_[idx(v)] = waiting;
    std::vector<std::int32_t> queue;
    for (const std::int32_t seed : nodes) {
        if (above_[idx(seed)] != waiting) continue;
        above_[idx(seed)] = outside;
        queue.assign(1, seed);
        for (std::size_t i = 0; i < queue.size(); ++i) {
            graph_.each(queue[i], [&](std::int32_t n, double) {
                if (above_[idx(n)] != waiting) return;
                above_[idx(n)] = outside;
                queue.push_back(n);
            });
            add(queue[i]);
        }
    }
}

}  // namespace vfplan
