// The overlap graph: candidates (or stations) joined where they overlap enough.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/parallel.h"
#include "engine/piece_rows.h"

namespace vfplan {

// Undirected, neighbours ascending, as compressed sparse rows.
struct Graph {
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int32_t> to;
    std::vector<double> overlap;

    std::int32_t size() const { return static_cast<std::int32_t>(begin.size()) - 1; }
    std::int64_t edges() const { return static_cast<std::int64_t>(to.size()) / 2; }
    // Calls f(neighbour, overlap).
    template <class F>
    void each(std::int32_t v, F&& f) const {
        for (auto i = static_cast<std::size_t>(begin[static_cast<std::size_t>(v)]);
             i < static_cast<std::size_t>(begin[static_cast<std::size_t>(v) + 1]); ++i) {
            f(to[i], overlap[i]);
        }
    }
};

Graph make_graph(std::int32_t nodes, const std::vector<OverlapPair>& pairs);

// The pairs of some consecutive rows with the rows after them: `count` of each row, one after
// another, ascending.
struct PairBlock {
    std::vector<std::int32_t> count;
    std::vector<std::int32_t> to;
    std::vector<double> overlap;
};

// All pairs of rows with O >= threshold (and > 0) by blocks of consecutive rows, in parallel. Time
// is the number of pieces that rows share, not of pairs of rows. `index` is of the rows.
std::vector<PairBlock> overlap_pairs(const Threads& threads, const PieceRows& rows,
                                     const PieceIndex& index,
                                     const std::vector<double>& piece_length_m, OverlapRatio ratio,
                                     double threshold);

// The graph of such pairs, which it eats up block by block.
Graph make_graph(std::vector<PairBlock> blocks);

// Both at once, from a coverage table.
Graph overlap_graph(const Threads& threads, const Pieces& pieces, const CoverageTable& table,
                    OverlapRatio ratio, double threshold);

// The part of a graph between `nodes` (ascending), renumbered by position.
Graph induced(const Graph& graph, const std::vector<std::int32_t>& nodes);

// Number of the connected component of each node, numbered by their first node.
std::vector<std::int32_t> components(const Graph& graph);

// Bridges, articulation nodes, and which nodes lie on a cycle. `lesser_part`: of what would remain
// of a node's component without the node, the size of the second largest part; 0 where it stays
// whole.
struct Cuts {
    std::int64_t bridges = 0;
    std::vector<std::uint8_t> articulation;
    std::vector<std::uint8_t> on_cycle;
    std::vector<std::int32_t> lesser_part;
};
Cuts find_cuts(const Graph& graph);

}  // namespace vfplan
