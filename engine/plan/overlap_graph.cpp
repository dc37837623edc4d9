#include "engine/plan/overlap_graph.h"

#include <algorithm>

#include "kernels/index.h"

namespace vfplan {

std::vector<PairBlock> overlap_pairs(const Threads& threads, const OverlapRows& rows,
                                     const PieceIndex& index,
                                     std::span<const double> piece_length_m,
                                     const OverlapRule& rule) {
    const std::vector<SeenTotal> totals = seen_totals(rows, piece_length_m);
    constexpr std::int32_t block = 256;
    std::vector<PairBlock> out(idx((rows.size() + block - 1) / block));
    const auto fill = [&](PairBlock& mine, std::int32_t first, PairSearch& search) {
        std::vector<std::pair<std::int32_t, double>> found;
        for (std::int32_t r = first; r < std::min(rows.size(), first + block); ++r) {
            found.clear();
            search.after(
                r, [](std::int32_t) { return true; },
                [&](std::int32_t n, const SeenJointly& joint) {
                    const double o = overlap(rule.ratio, totals[idx(r)], totals[idx(n)], joint);
                    if (rule.enough(o)) found.emplace_back(n, o);
                });
            std::sort(found.begin(), found.end());
            mine.count.push_back(static_cast<std::int32_t>(found.size()));
            for (const auto& [n, o] : found) {
                mine.to.push_back(n);
                mine.overlap.push_back(o);
            }
        }
        mine.to.shrink_to_fit();
        mine.overlap.shrink_to_fit();
    };
    threads.for_each(
        static_cast<std::int64_t>(out.size()), 1, [&](std::int64_t from, std::int64_t to) {
            PairSearch search(rows, index, piece_length_m, formula(rule.ratio).by_angle);
            for (std::int64_t b = from; b < to; ++b) {
                fill(out[idx(b)], static_cast<std::int32_t>(b) * block, search);
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
        for (const std::int32_t n : b.to) ++g.begin[idx(n) + 1];
    }
    for (std::size_t v = 1; v < g.begin.size(); ++v) g.begin[v] += g.begin[v - 1];
    g.to.resize(idx(g.begin.back()));
    g.overlap.resize(g.to.size());
    std::vector<std::int64_t> next(g.begin.begin(), g.begin.end() - 1);
    const auto add = [&](std::int32_t from, std::int32_t to, double overlap) {
        const auto i = idx(next[idx(from)]++);
        g.to[i] = to;
        g.overlap[i] = overlap;
    };
    // Rows ascend: when a row's turn comes, it has all its smaller neighbours already.
    std::int32_t from = 0;
    for (PairBlock& b : blocks) {
        std::size_t i = 0;
        for (const std::int32_t n : b.count) {
            for (const std::size_t end = i + idx(n); i < end; ++i) {
                add(from, b.to[i], b.overlap[i]);
                add(b.to[i], from, b.overlap[i]);
            }
            ++from;
        }
        b = {};
    }
    return g;
}

}  // namespace vfplan
