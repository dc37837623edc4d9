#include "engine/graphs/blocks.h"

#include <algorithm>
#include <vector>

namespace vfplan {

// Lowest-reachable numbering (Tarjan), without recursion: what a child cannot leave upwards but
// through its parent is a block with it.
Sparse find_blocks(const Sparse& near, std::int32_t* parts) {
    const auto n = idx(near.size());
    Sparse out;
    std::vector<std::int32_t> order(n, -1);
    std::vector<std::int32_t> low(n, 0);
    std::vector<std::int32_t> parent(n, -1);
    std::vector<std::int64_t> next(near.begin.begin(), near.begin.end() - 1);
    std::vector<std::int32_t> stack;
    std::vector<std::int32_t> open;  // met, in no block yet
    std::int32_t clock = 0;
    std::int32_t roots = 0;
    for (std::size_t root = 0; root < n; ++root) {
        if (order[root] >= 0) continue;
        ++roots;
        order[root] = low[root] = clock++;
        stack.push_back(static_cast<std::int32_t>(root));
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            if (next[idx(v)] < near.begin[idx(v) + 1]) {
                const std::int32_t w = near.to[idx(next[idx(v)]++)];
                if (order[idx(w)] < 0) {
                    parent[idx(w)] = v;
                    order[idx(w)] = low[idx(w)] = clock++;
                    stack.push_back(w);
                    open.push_back(w);
                } else {
                    low[idx(v)] = std::min(low[idx(v)], order[idx(w)]);
                }
                continue;
            }
            stack.pop_back();
            const std::int32_t p = parent[idx(v)];
            if (p < 0) continue;
            low[idx(p)] = std::min(low[idx(p)], low[idx(v)]);
            if (low[idx(v)] < order[idx(p)]) continue;
            out.to.push_back(p);
            for (std::int32_t w = -1; w != v;) {
                w = open.back();
                open.pop_back();
                out.to.push_back(w);
            }
            out.end_list();
        }
    }
    if (parts != nullptr) *parts = roots;
    return out;
}

}  // namespace vfplan
