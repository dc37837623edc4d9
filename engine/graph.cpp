#include "engine/graph.h"
#include "kernels/index.h"

#include <algorithm>
#include <unordered_map>

namespace vfplan {
Graph make_graph(std::int32_t nodes, const std::vector<OverlapPair>& pairs) {
    Graph g;
    g.begin.assign(at(nodes) + 1, 0);
    for (const OverlapPair& p : pairs) {
        ++g.begin[at(p.from) + 1];
        ++g.begin[at(p.to) + 1];
    }
    for (std::size_t v = 0; v < at(nodes); ++v) g.begin[v + 1] += g.begin[v];
    g.to.resize(2 * pairs.size());
    g.overlap.resize(2 * pairs.size());
    std::vector<std::int64_t> next(g.begin.begin(), g.begin.end() - 1);
    const auto add = [&](std::int32_t from, std::int32_t to, double overlap) {
        const auto i = at(next[at(from)]++);
        g.to[i] = to;
        g.overlap[i] = overlap;
    };
    // Pairs come ascending in (from, to): first all smaller neighbours, then all larger ones.
    for (const OverlapPair& p : pairs) add(p.to, p.from, p.overlap);
    for (const OverlapPair& p : pairs) add(p.from, p.to, p.overlap);
    return g;
}

Graph overlap_graph(const Threads& threads, const Pieces& pieces, const CoverageTable& table,
                    OverlapRatio ratio, double threshold) {
    const std::int64_t rows = table.rows();
    const InvertedIndex index = invert(table, pieces.size());
    std::vector<SeenTotal> totals(at(rows));
    for (std::int64_t r = 0; r < rows; ++r) {
        totals[at(r)] = seen_total(pieces, table.row_begin(r), table.row_end(r));
    }
    constexpr std::int64_t block = 64;
    std::vector<std::vector<OverlapPair>> found(at((rows + block - 1) / block));
    threads.for_each(
        static_cast<std::int64_t>(found.size()), 1, [&](std::int64_t from, std::int64_t to) {
            OverlapScratch scratch;
            for (std::int64_t b = from; b < to; ++b) {
                const std::int64_t last = std::min(rows, (b + 1) * block);
                for (std::int64_t r = b * block; r < last; ++r) {
                    overlaps_of_row(pieces, table, index, totals, ratio, threshold,
                                    static_cast<std::int32_t>(r), scratch, found[at(b)]);
                }
            }
        });
    std::vector<OverlapPair> pairs;
    for (const auto& part : found) pairs.insert(pairs.end(), part.begin(), part.end());
    return make_graph(static_cast<std::int32_t>(rows), pairs);
}

Graph induced(const Graph& graph, const std::vector<std::int32_t>& nodes) {
    std::unordered_map<std::int32_t, std::int32_t> position;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        position.emplace(nodes[i], static_cast<std::int32_t>(i));
    }
    std::vector<OverlapPair> pairs;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        graph.each(nodes[i], [&](std::int32_t n, double overlap) {
            const auto found = position.find(n);
            if (found == position.end() || found->second <= static_cast<std::int32_t>(i)) return;
            pairs.push_back({static_cast<std::int32_t>(i), found->second, overlap});
        });
    }
    return make_graph(static_cast<std::int32_t>(nodes.size()), pairs);
}

std::vector<std::int32_t> components(const Graph& graph) {
    std::vector<std::int32_t> number(at(graph.size()), -1);
    std::vector<std::int32_t> stack;
    std::int32_t count = 0;
    for (std::int32_t seed = 0; seed < graph.size(); ++seed) {
        if (number[at(seed)] >= 0) continue;
        number[at(seed)] = count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            stack.pop_back();
            graph.each(v, [&](std::int32_t n, double) {
                if (number[at(n)] >= 0) return;
                number[at(n)] = count;
                stack.push_back(n);
            });
        }
        ++count;
    }
    return number;
}

// Lowest-reachable numbering (Tarjan), without recursion. The graph has no parallel edges.
Cuts find_cuts(const Graph& graph) {
    const auto n = at(graph.size());
    Cuts cuts;
    cuts.articulation.assign(n, 0);
    cuts.on_cycle.assign(n, 0);
    std::vector<std::int32_t> order(n, -1);
    std::vector<std::int32_t> low(n, 0);
    std::vector<std::int32_t> parent(n, -1);
    std::vector<std::int64_t> next(graph.begin.begin(), graph.begin.end() - 1);
    std::vector<std::int32_t> stack;
    std::int32_t clock = 0;
    for (std::int32_t root = 0; root < graph.size(); ++root) {
        if (order[at(root)] >= 0) continue;
        int root_children = 0;
        order[at(root)] = low[at(root)] = clock++;
        stack.push_back(root);
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            if (next[at(v)] < graph.begin[at(v) + 1]) {
                const std::int32_t w = graph.to[at(next[at(v)]++)];
                if (order[at(w)] < 0) {
                    parent[at(w)] = v;
                    order[at(w)] = low[at(w)] = clock++;
                    stack.push_back(w);
                    if (v == root) ++root_children;
                } else if (w != parent[at(v)]) {
                    low[at(v)] = std::min(low[at(v)], order[at(w)]);
                }
                continue;
            }
            stack.pop_back();
            const std::int32_t p = parent[at(v)];
            if (p < 0) continue;
            low[at(p)] = std::min(low[at(p)], low[at(v)]);
            if (low[at(v)] > order[at(p)]) {
                ++cuts.bridges;
            } else {
                cuts.on_cycle[at(v)] = cuts.on_cycle[at(p)] = 1;
            }
            if (p != root && low[at(v)] >= order[at(p)]) cuts.articulation[at(p)] = 1;
        }
        if (root_children > 1) cuts.articulation[at(root)] = 1;
    }
    return cuts;
}

}  // namespace vfplan
