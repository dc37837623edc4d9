// The overlap graph of a whole coverage table.
#pragma once

#include "engine/plan/overlap_graph.h"
#include "kernels/coverage.h"

namespace vfplan::test {

inline Graph graph_of(const Threads& threads, const Pieces& pieces, const CoverageTable& table,
                      const OverlapRule& rule) {
    const OverlapRows rows = overlap_rows(table, formula(rule.ratio).by_angle);
    return make_graph(
        overlap_pairs(threads, rows, index_of(rows, pieces.size()), piece_lengths_m(pieces), rule));
}

}  // namespace vfplan::test
