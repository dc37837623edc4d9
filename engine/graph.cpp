#include "engine/graph.h"
#include "kernels/index.h"

#include <algorithm>

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

std::vector<PairBlock> overlap_pairs(const Threads& threads, const PieceRows& rows,
                                     const PieceIndex& index,
                                     const std::vector<double>& piece_length_m, OverlapRatio ratio,
                                     double threshold) {
    const std::vector<SeenTotal> totals = seen_totals(rows, piece_length_m);
    constexpr std::int32_t block = 256;
    std::vector<PairBlock> out(at((rows.size() + block - 1) / block));
    const auto find = [&](std::int32_t r, SharedLengths& shared, std::vector<OverlapPair>& found) {
        for (const std::int32_t p : rows.row(r)) {
            const std::span<const std::int32_t> viewers = index.rows_of(p);
            for (auto n = std::upper_bound(viewers.begin(), viewers.end(), r); n != viewers.end();
                 ++n) {
                shared.add(*n, piece_length_m[at(p)]);
            }
        }
        const std::size_t first = found.size();
        shared.take([&](std::int32_t n, double length_m) {
            SeenJointly joint{length_m, 0, 0};
            // The angle from the other side is not in the index.
            if (by_angle(ratio)) joint = seen_jointly(rows, piece_length_m, r, n);
            const double o = overlap(ratio, totals[at(r)], totals[at(n)], joint);
            if (o > 0 && o >= threshold) found.push_back({r, n, o});
        });
        std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
                  [](const OverlapPair& a, const OverlapPair& b) { return a.to < b.to; });
        return static_cast<std::int32_t>(found.size() - first);
    };
    threads.for_each(static_cast<std::int64_t>(out.size()), 1,
                     [&](std::int64_t from, std::int64_t to) {
                         SharedLengths shared;
                         std::vector<OverlapPair> found;
                         for (std::int64_t b = from; b < to; ++b) {
                             const auto first = static_cast<std::int32_t>(b) * block;
                             const std::int32_t last = std::min(rows.size(), first + block);
                             PairBlock& mine = out[at(b)];
                             found.clear();
                             for (std::int32_t r = first; r < last; ++r) {
                                 mine.count.push_back(find(r, shared, found));
                             }
                             mine.to.reserve(found.size());
                             mine.overlap.reserve(found.size());
                             for (const OverlapPair& p : found) {
                                 mine.to.push_back(p.to);
                                 mine.overlap.push_back(p.overlap);
                             }
                         }
                     });
    return out;
}

Graph make_graph(std::vector<PairBlock> blocks) {
    Graph g;
    for (const PairBlock& b : blocks) {
        for (const std::int32_t n : b.count) g.begin.push_back(n);
    }
    for (const PairBlock& b : blocks) {
        for (const std::int32_t n : b.to) ++g.begin[at(n) + 1];
    }
    for (std::size_t v = 1; v < g.begin.size(); ++v) g.begin[v] += g.begin[v - 1];
    g.to.resize(at(g.begin.back()));
    g.overlap.resize(g.to.size());
    std::vector<std::int64_t> next(g.begin.begin(), g.begin.end() - 1);
    const auto add = [&](std::int32_t from, std::int32_t to, double overlap) {
        const auto i = at(next[at(from)]++);
        g.to[i] = to;
        g.overlap[i] = overlap;
    };
    // Rows ascend: when a row's turn comes, it has all its smaller neighbours already.
    std::int32_t from = 0;
    for (PairBlock& b : blocks) {
        std::size_t i = 0;
        for (const std::int32_t n : b.count) {
            for (const std::size_t end = i + at(n); i < end; ++i) {
                add(from, b.to[i], b.overlap[i]);
                add(b.to[i], from, b.overlap[i]);
            }
            ++from;
        }
        b = {};
    }
    return g;
}

Graph overlap_graph(const Threads& threads, const Pieces& pieces, const CoverageTable& table,
                    OverlapRatio ratio, double threshold) {
    const PieceRows rows = piece_rows(table, by_angle(ratio));
    return make_graph(overlap_pairs(threads, rows, index_of(rows, pieces.size()),
                                    piece_lengths_m(pieces), ratio, threshold));
}

Graph induced(const Graph& graph, const std::vector<std::int32_t>& nodes) {
    std::vector<std::int32_t> position(at(graph.size()), -1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        position[at(nodes[i])] = static_cast<std::int32_t>(i);
    }
    Graph part;
    part.begin.reserve(nodes.size() + 1);
    for (const std::int32_t v : nodes) {
        graph.each(v, [&](std::int32_t n, double overlap) {
            if (position[at(n)] < 0) return;
            part.to.push_back(position[at(n)]);
            part.overlap.push_back(overlap);
        });
        part.begin.push_back(static_cast<std::int64_t>(part.to.size()));
    }
    return part;
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

namespace {

// The two largest of the parts that a node would leave, while they are being found.
struct Parts {
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

// Lowest-reachable numbering (Tarjan), without recursion. The graph has no parallel edges.
Cuts find_cuts(const Graph& graph) {
    const auto n = at(graph.size());
    Cuts cuts;
    cuts.articulation.assign(n, 0);
    cuts.on_cycle.assign(n, 0);
    cuts.lesser_part.assign(n, 0);
    std::vector<std::int32_t> order(n, -1);
    std::vector<std::int32_t> low(n, 0);
    std::vector<std::int32_t> parent(n, -1);
    std::vector<std::int32_t> below(n, 1);  // nodes at and below each, in the search's tree
    std::vector<Parts> parts(n);
    std::vector<std::int64_t> next(graph.begin.begin(), graph.begin.end() - 1);
    std::vector<std::int32_t> stack;
    std::vector<std::int32_t> met;  // of one component, in their order
    std::int32_t clock = 0;
    for (std::int32_t root = 0; root < graph.size(); ++root) {
        if (order[at(root)] >= 0) continue;
        order[at(root)] = low[at(root)] = clock++;
        stack.push_back(root);
        met.assign(1, root);
        while (!stack.empty()) {
            const std::int32_t v = stack.back();
            if (next[at(v)] < graph.begin[at(v) + 1]) {
                const std::int32_t w = graph.to[at(next[at(v)]++)];
                if (order[at(w)] < 0) {
                    parent[at(w)] = v;
                    order[at(w)] = low[at(w)] = clock++;
                    stack.push_back(w);
                    met.push_back(w);
                } else if (w != parent[at(v)]) {
                    low[at(v)] = std::min(low[at(v)], order[at(w)]);
                }
                continue;
            }
            stack.pop_back();
            const std::int32_t p = parent[at(v)];
            if (p < 0) continue;
            low[at(p)] = std::min(low[at(p)], low[at(v)]);
            below[at(p)] += below[at(v)];
            if (low[at(v)] > order[at(p)]) {
                ++cuts.bridges;
            } else {
                cuts.on_cycle[at(v)] = cuts.on_cycle[at(p)] = 1;
            }
            if (low[at(v)] >= order[at(p)]) parts[at(p)].add(below[at(v)]);
        }
        for (const std::int32_t v : met) {  // what is left lies above; nothing does above the root
            parts[at(v)].add(below[at(root)] - 1 - parts[at(v)].all);
            cuts.lesser_part[at(v)] = parts[at(v)].second;
            cuts.articulation[at(v)] = parts[at(v)].second > 0 ? 1 : 0;
        }
    }
    return cuts;
}

}  // namespace vfplan
