#include "engine/plan/overlap_graph.h"

#include <algorithm>

#include "kernels/index.h"

namespace vfplan {

namespace {

constexpr std::int32_t block_rows = 256;

// Appends the pairs of a block's rows with rows of the index that come after them.
void add_pairs(const OverlapRows& rows, const OverlapRule& rule,
               const std::vector<SeenTotal>& totals, PairSearch& search, std::int32_t first,
               PairBlock& out) {
    std::vector<std::pair<std::int32_t, double>> found;
    for (std::int32_t r = first; r < std::min(rows.size(), first + block_rows); ++r) {
        found.clear();
        search.after(
            r, [](std::int32_t) { return true; },
            [&](std::int32_t n, const SeenJointly& joint) {
                const double o = overlap(rule.ratio, totals[idx(r)], totals[idx(n)], joint);
                if (rule.enough(o)) found.emplace_back(n, o);
            });
        std::sort(found.begin(), found.end());
        out.count.push_back(static_cast<std::int32_t>(found.size()));
        for (const auto& [n, o] : found) {
            out.to.push_back(n);
            out.overlap.push_back(o);
        }
    }
    out.to.shrink_to_fit();
    out.overlap.shrink_to_fit();
}

// Puts pairs of the same rows behind those with lower rows.
void append(const PairBlock& more, PairBlock& block) {
    PairBlock out;
    std::size_t i = 0;
    std::size_t k = 0;
    const auto take = [&](const PairBlock& from, std::size_t& at, std::int32_t count) {
        for (const std::size_t end = at + idx(count); at < end; ++at) {
            out.to.push_back(from.to[at]);
            out.overlap.push_back(from.overlap[at]);
        }
    };
    for (std::size_t r = 0; r < block.count.size(); ++r) {
        take(block, i, block.count[r]);
        take(more, k, more.count[r]);
        out.count.push_back(block.count[r] + more.count[r]);
    }
    block = std::move(out);
}

}  // namespace

std::vector<PairBlock> overlap_pairs(const Threads& threads, const OverlapRows& rows,
                                     std::span<const double> piece_length_m,
                                     const OverlapRule& rule, std::int64_t entries_at_once) {
    const std::vector<SeenTotal> totals = seen_totals(rows, piece_length_m);
    std::vector<PairBlock> out(idx((rows.size() + block_rows - 1) / block_rows));
    for (std::int32_t from = 0, to = 0; from < rows.size(); from = to) {
        do {
            ++to;
        } while (to < rows.size() &&
                 rows.begin[idx(to) + 1] - rows.begin[idx(from)] <= entries_at_once);
        const PieceIndex index =
            index_of(rows, static_cast<std::int64_t>(piece_length_m.size()), from, to);
        const std::int64_t blocks = (to + block_rows - 1) / block_rows;  // with rows before others
        threads.for_each(blocks, 1, [&](std::int64_t begin, std::int64_t end) {
            PairSearch search(rows, index, piece_length_m, formula(rule.ratio).by_angle);
            for (std::int64_t b = begin; b < end; ++b) {
                PairBlock& block = out[idx(b)];
                const auto first = static_cast<std::int32_t>(b) * block_rows;
                if (block.count.empty()) {
                    add_pairs(rows, rule, totals, search, first, block);
                } else {
                    PairBlock more;
                    add_pairs(rows, rule, totals, search, first, more);
                    append(more, block);
                }
            }
        });
    }
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
