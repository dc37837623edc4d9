// Which sets of candidates cells join, and the shortest chains that do: from rows alone, without
// geometry (docs/method.md 6).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/runtime/parallel.h"
#include "io/tables/join_shards.h"
#include "kernels/overlap_rows.h"

namespace vfplan {

// Rows of some candidates, then of cells. Refers to what outlives it.
struct JoinProblem {
    const LocalRows& local;
    const std::vector<std::int32_t>& component;  // of each of these candidates
    std::int64_t components = 0;                 // of the overlap graph over all candidates
    OverlapRule rule;

    std::int32_t candidates() const { return static_cast<std::int32_t>(component.size()); }
    std::int32_t cells() const { return local.rows.size() - candidates(); }
};

inline constexpr std::int32_t beside_a_candidate = -1;
inline constexpr std::int32_t joins_nothing = -2;
inline constexpr std::int32_t left_out = -1;  // in place of a set
// Pairs of a row and a viewer of one of its pieces that are looked at for each step of chains: some
// seconds. Where there are more, chains are cut short (Joined::complete).
inline constexpr std::int64_t viewers_most = 1'000'000'000;

struct Joined {
    // False: cells beside no candidate are left out, so chains have two cells at most, or one where
    // there are too many pairs of these, too.
    bool complete = true;
    // A set is named by its first component; one without any by a number behind the last component;
    // a cell that is left out has none.
    std::vector<std::int32_t> set_of_component;
    std::vector<std::int32_t> set_of_cell;
    // The cell that is next to each one on a shortest chain to a candidate; or one of the above.
    std::vector<std::int32_t> next;
    // Cells that join components, on the shortest chains there are, ascending.
    std::vector<std::int32_t> connectors;
};

// The components of the graph over candidates and cells, by the rule. Shorter chains join first;
// of equal ones those of cells that join most, then of the first cells. The number of threads
// changes nothing.
//  (1) two components are in one set iff a chain of cells joins them (of those not left out)
//  (2) with the connectors as candidates they are in one component iff they are in one set
Joined join(const Threads& threads, const JoinProblem& problem,
            std::int64_t viewers = viewers_most);

// Between each two sets that share a piece the largest overlap; a < b, ascending. Nothing where
// chains were cut short.
std::vector<SetPair> largest_overlaps(const Threads& threads, const JoinProblem& problem,
                                      const Joined& joined);

}  // namespace vfplan
