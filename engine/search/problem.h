// The problem of one network (docs/planning.md): choose the fewest columns that cover all rows and
// hang together.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graphs/sparse.h"

namespace vfplan {

// Columns are candidates of one component of the overlap graph, rows are pieces that the network
// has to cover. All lists ascend; every row has a column; the columns hang together.
struct Problem {
    Sparse rows_of;                   // by column
    Sparse columns_of;                // by row
    Sparse near;                      // by column: those that it overlaps enough with
    std::vector<std::uint8_t> fixed;  // by column: stands in every plan
    // Where cycles count, else empty: by column the part of the graph that no single link's loss
    // divides. Links within a part could be on a cycle, links between parts never.
    std::vector<std::int32_t> block;
    // Likewise: how many stations a column is, when those off every cycle are counted.
    std::vector<std::int32_t> loose;
    // Likewise: 1 where some link of the column could be on a cycle whatever else is chosen. May be
    // empty: none.
    std::vector<std::uint8_t> closable;
    // By column those that stand too near by; may be empty: none do.
    Sparse beside;

    std::int32_t columns() const { return rows_of.size(); }
    std::int32_t rows() const { return columns_of.size(); }
};

// Columns of a problem that were chosen, ascending.
using Choice = std::vector<std::int32_t>;

// A chosen column is loose when it is on no cycle of links, though one of its links could be.

// True if the choice covers all rows, hangs together and holds all fixed columns.
bool is_plan(const Problem& problem, const Choice& choice);

}  // namespace vfplan
