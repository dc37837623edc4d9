// The overlap graph of a whole coverage table.
#pragma once

#include "engine/plan/overlap_graph.h"
#include "kernels/coverage.h"

namespace vfplan::test {

inline Graph graph_of(const Threads& threads, const Pieces& pieces, const CoverageTable& table,
                      const OverlapRule& rule, std::int64_t entries_at_once = 1 << 26) {
    const OverlapRows rows = overlap_rows(table, formula(rule.ratio).by_angle);
    return make_graph(overlap_pairs(threads, rows, piece_lengths_m(pieces), rule, entries_at_once));
}

}  // namespace vfplan::test
