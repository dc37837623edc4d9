// Proofs about small problems, as the checker sees them.
#pragma once

#include <numeric>
#include <string>
#include <vector>

#include "engine/check/proof_check.h"
#include "engine/search/problem.h"

namespace vfplan::test {

// What is wrong with a proof about a problem, empty where nothing is: columns are candidates, rows
// pieces.
inline std::string wrong_with(const Problem& p, const NetworkProof& proof) {
    const OverlapRows rows{p.rows_of.begin, p.rows_of.to, {}};
    std::vector<std::vector<std::int32_t>> near;
    for (std::int32_t c = 0; c < p.columns(); ++c) {
        near.emplace_back(p.near.of(c).begin(), p.near.of(c).end());
    }
    const std::vector<std::int32_t> owner(idx(p.rows()), 0);
    std::vector<std::int32_t> members(near.size());
    std::iota(members.begin(), members.end(), 0);
    const CheckTables tables{rows, near, owner, p.fixed};
    return ProofCheck(tables).wrong(0, members, proof);
}

}  // namespace vfplan::test
