// The planning of one network as a problem of its own (docs/planning.md).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/plan/workspace.h"
#include "engine/search/problem.h"

namespace vfplan {

struct Network {
    std::vector<std::int32_t> members;  // a component of the graph, ascending
    Chosen chosen;
    Chosen connected;  // the best plan before loops count
};

// Room for all networks of a job, so that a small one costs what it holds.
class NetworkProblems {
public:
    explicit NetworkProblems(const PlanInput& input)
        : in_(input),
          column_(input.candidates.size(), -1),
          class_(input.piece_length_m.size(), -1) {}

    // Columns: `members`, a component, ascending. Rows: pieces with owner[piece] == network; those
    // that the same candidates cover are one row. Fixed: fixed[candidate].
    Problem of(const std::vector<std::int32_t>& members, const std::vector<std::int32_t>& owner,
               std::int32_t network, const std::vector<std::uint8_t>& fixed);
    // A piece of each row of the last problem.
    const std::vector<std::int32_t>& pieces() const { return piece_; }

private:
    const PlanInput& in_;
    std::vector<std::int32_t> column_;  // of candidates
    std::vector<std::int32_t> class_;   // of pieces
    std::vector<std::int32_t> piece_;   // of rows
};

// The columns of chosen candidates. REQUIRES: they are among the members.
Choice columns_of(const std::vector<std::int32_t>& members, const Chosen& chosen);

}  // namespace vfplan
