#include "engine/graphs/graph.h"

namespace vfplan {

Graph make_graph(std::int32_t nodes, const std::vector<OverlapPair>& pairs) {
    Graph g;
    g.begin.assign(idx(nodes) + 1, 0);
    for (const OverlapPair& p : pairs) {
        ++g.begin[idx(p.from) + 1];
        ++g.begin[idx(p.to) + 1];
    }
    for (std::size_t v = 0; v < idx(nodes); ++v) g.begin[v + 1] += g.begin[v];
    g.to.resize(2 * pairs.size());
    g.overlap.resize(2 * pairs.size());
    std::vector<std::int64_t> next(g.begin.begin(), g.begin.end() - 1);
    const auto add = [&](std::int32_t from, std::int32_t to, double overlap) {
        const auto i = idx(next[idx(from)]++);
        g.to[i] = to;
        g.overlap[i] = overlap;
    };
    // Pairs come ascending in (from, to): first all smaller neighbours, then all larger ones.
    for (const OverlapPair& p : pairs) add(p.to, p.from, p.overlap);
    for (const OverlapPair& p : pairs) add(p.from, p.to, p.overlap);
    return g;
}

Graph induced(const Graph& graph, const std::vector<std::int32_t>& nodes) {
    std::vector<std::int32_t> position(idx(graph.size()), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        position[idx(nodes[i])] = static_cast<std::int32_t>(i);
    }
    Graph part;
    part.begin.reserve(nodes.size() + 1);
    for (const std::int32_t v : nodes) {
        graph.each(v, [&](std::int32_t n, double overlap) {
            if (position[idx(n)] < 0) return;
            part.to.push_back(position[idx(n)]);
            part.overlap.push_back(overlap);
        });
        part.begin.push_back(static_cast<std::int64_t>(part.to.size()));
    }
    return part;
}

std::vector<std::int32_t> components(const Graph& graph) {
    std::vector<std::int32_t> number(idx(graph.size()), -1);
    std::vector<std::int32_t> stack;
    std::int32_t count = 0;
    for (std::int32_t seed = 0; seed < graph.size(); ++seed) {
        if (number[idx(seed)] >= 0) continue;
        number[idx(seed)] = count;
        stack.push_back(seed);
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            stack.pop_back();
            graph.each(v, [&](std::int32_t n, double) {
                if (number[idx(n)] >= 0) return;
                number[idx(n)] = count;
                stack.push_back(n);
            });
        }
        ++count;
    }
    return number;
}

}  // namespace vfplan
