#include "engine/graphs/separation.h"

#include <utility>

#include "kernels/index.h"

namespace vfplan {

Separation::Separation(const Graph& graph, std::vector<std::uint8_t> inside)
    : graph_(graph), inside_(std::move(inside)), side_of_(idx(graph.size()), -1) {}

Separation::Separation(const Graph& graph)
    : Separation(graph, std::vector<std::uint8_t>(idx(graph.size()), 0)) {}

std::size_t Separation::root(std::size_t side) const {
    while (sides_[side].joined_to != side) side = sides_[side].joined_to;
    return side;
}

// Looks around the next node of a side's queue.
void Separation::step(std::size_t side, std::int32_t without) {
    Side& s = sides_[side];
    if (s.next == s.queue.size()) return;
    const std::int32_t v = s.queue[s.next++];
    ++steps_;
    graph_.each(v, [&](std::int32_t n, double) {
        if (n == without || inside_[idx(n)] == 0) return;
        if (side_of_[idx(n)] < 0) {
            side_of_[idx(n)] = static_cast<std::int32_t>(side);
            s.queue.push_back(n);
            return;
        }
        const std::size_t mine = root(side);
        const std::size_t other = root(idx(side_of_[idx(n)]));
        if (mine == other) return;
        sides_[other].joined_to = mine;
        --apart_;
    });
}

// All searches that belong to a root have nowhere to go.
bool Separation::finished(std::size_t side) const {
    for (std::size_t i = 0; i < sides_.size(); ++i) {
        if (root(i) == side && sides_[i].next < sides_[i].queue.size()) return false;
    }
    return true;
}

bool Separation::can_go(std::int32_t node) {
    sides_.clear();
    graph_.each(node, [&](std::int32_t n, double) {
        if (inside_[idx(n)] == 0) return;
        side_of_[idx(n)] = static_cast<std::int32_t>(sides_.size());
        sides_.push_back({{n}, 0, sides_.size()});
    });
    const std::size_t count = sides_.size();
    apart_ = count;
    bool met = count < 2;
    std::size_t going = count;  // roots that may still meet another
    while (going > 1 && !met) {
        for (std::size_t i = 0; i < count && !met; ++i) {
            step(i, node);
            met = apart_ == 1;
        }
        if (met) break;
        going = 0;
        bool closed = false;
        for (std::size_t i = 0; i < count; ++i) {
            if (sides_[i].joined_to != i) continue;
            if (finished(i)) {
                closed = true;
            } else {
                ++going;
            }
        }
        if (closed) break;  // one side holds nothing of the others
    }
    for (const Side& s : sides_) {
        for (const std::int32_t v : s.queue) side_of_[idx(v)] = -1;
    }
    return met;
}

}  // namespace vfplan
