#include "engine/graphs/cuts.h"

#include <algorithm>

#include "kernels/index.h"

namespace vfplan {
namespace {

// The two largest of the parts that a node would leave, while they are being found.
struct Sides {
    std::int32_t all = 0;
    std::int32_t largest = 0;
    std::int32_t second = 0;
    void add(std::int32_t size) {
        all += size;
        second = std::max(second, std::min(largest, size));
        largest = std::max(largest, size);
    }
};

}  // namespace

// Lowest-reachable numbering (Tarjan), without recursion. The edge to the parent is passed over
// once: where there are two, they are a cycle.
Cuts find_cuts(const Graph& graph) {
    const auto n = idx(graph.size());
    Cuts cuts;
    cuts.articulation.assign(n, 0);
    cuts.on_cycle.assign(n, 0);
    cuts.lesser_part.assign(n, 0);
    cuts.block.assign(n, 0);
    std::vector<std::int32_t> order(n, -1);
    std::vector<std::int32_t> low(n, 0);
    std::vector<std::int32_t> parent(n, -1);
    std::vector<std::uint8_t> passed(n, 0);
    std::vector<std::int32_t> below(n, 1);  // nodes at and below each, in the search's tree
    std::vector<Sides> sides(n);
    std::vector<std::int64_t> next(graph.begin.begin(), graph.begin.end() - 1);
    std::vector<std::int32_t> stack;
    std::vector<std::int32_t> met;  // of one component, in their order
    std::int32_t clock = 0;
    std::int32_t blocks = 0;
    for (std::int32_t root = 0; root < graph.size(); ++root) {
        if (order[idx(root)] >= 0) continue;
        order[idx(root)] = low[idx(root)] = clock++;
        stack.push_back(root);
        met.assign(1, root);
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            if (next[idx(v)] < graph.begin[idx(v) + 1]) {
                const std::int32_t w = graph.to[idx(next[idx(v)]++)];
                if (order[idx(w)] < 0) {
                    parent[idx(w)] = v;
                    order[idx(w)] = low[idx(w)] = clock++;
                    stack.push_back(w);
                    met.push_back(w);
                } else if (w == parent[idx(v)] && passed[idx(v)] == 0) {
                    passed[idx(v)] = 1;
                } else {
                    low[idx(v)] = std::min(low[idx(v)], order[idx(w)]);
                }
                continue;
            }
            stack.pop_back();
            const std::int32_t p = parent[idx(v)];
            if (p < 0) continue;
            low[idx(p)] = std::min(low[idx(p)], low[idx(v)]);
            below[idx(p)] += below[idx(v)];
            if (low[idx(v)] > order[idx(p)]) {
                ++cuts.bridges;
            } else {
                cuts.on_cycle[idx(v)] = cuts.on_cycle[idx(p)] = 1;
            }
            if (low[idx(v)] >= order[idx(p)]) sides[idx(p)].add(below[idx(v)]);
        }
        for (const std::int32_t v : met) {  // parents come first
            const std::int32_t p = parent[idx(v)];
            const bool apart = p < 0 || low[idx(v)] > order[idx(p)];
            cuts.block[idx(v)] = apart ? blocks++ : cuts.block[idx(p)];
        }
        for (const std::int32_t v : met) {  // what is left lies above; nothing does above the root
            sides[idx(v)].add(below[idx(root)] - 1 - sides[idx(v)].all);
            cuts.lesser_part[idx(v)] = sides[idx(v)].second;
            cuts.articulation[idx(v)] = sides[idx(v)].second > 0 ? 1 : 0;
        }
    }
    return cuts;
}

}  // namespace vfplan
