// The overlap graph: candidates joined where they overlap enough (equations 8 to 12).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/graphs/graph.h"
#include "engine/runtime/parallel.h"
#include "kernels/overlap_rows.h"

namespace vfplan {

// The pairs of some consecutive rows with the rows after them: `count` of each row, one after
// another, ascending.
struct PairBlock {
    std::vector<std::int32_t> count;
    std::vector<std::int32_t> to;
    std::vector<double> overlap;
};

// All pairs of rows that overlap enough, by blocks of consecutive rows, in parallel. An index is
// made of some rows at a time, with no more entries than this or of one row. Neither that nor the
// number of threads changes anything.
std::vector<PairBlock> overlap_pairs(const Threads& threads, const OverlapRows& rows,
                                     std::span<const double> piece_length_m,
                                     const OverlapRule& rule,
                                     std::int64_t entries_at_once = std::int64_t{1} << 26);

// The graph of such pairs, which it eats up block by block.
Graph make_graph(std::vector<PairBlock> blocks);

}  // namespace vfplan
