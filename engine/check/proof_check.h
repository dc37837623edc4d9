// The proof of a network's bound, checked by means that share nothing with those that found it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "kernels/certificate.h"
#include "kernels/overlap_rows.h"

namespace vfplan {

// What proofs are checked against: candidates with the pieces they cover and the candidates they
// overlap enough with, both ascending. Refers to what outlives it.
struct CheckTables {
    const OverlapRows& rows;
    const std::vector<std::vector<std::int32_t>>& near;
    const std::vector<std::int32_t>& owner;     // by piece: the network that has to cover it, or -1
    const std::vector<std::uint8_t>& standing;  // by candidate: it must be a station
};

// Nothing in a proof is trusted: each line says something true of every plan, whatever it names,
// and what does not fit is refused. Room for many proofs; not thread-safe.
class ProofCheck {
public:
    explicit ProofCheck(const CheckTables& tables);

    // What is wrong with the proof that network `number`, whose candidates are `members`, needs
    // proof.bound stations; empty where nothing is.
    std::string wrong(std::int32_t number, std::span<const std::int32_t> members,
                      const NetworkProof& proof);

private:
    void remove_gone(const NetworkProof& proof);
    void check_line(const ProofLine& line);
    // Reads the tree of cases from `next` on; returns the least value of its leaves.
    std::int64_t value_of_cases(const NetworkProof& proof, std::size_t& next);
    std::int64_t value_of_leaf(const NetworkProof& proof, const ProofCase& leaf);
    void add(const ProofLine& line, std::int64_t weight);
    bool is_piece(std::int32_t piece) const;
    bool is_candidate(std::int32_t candidate) const;
    std::int64_t& way(std::int32_t from, std::int32_t to);

    const CheckTables& t_;
    std::int32_t number_ = 0;
    std::span<const std::int32_t> members_;
    std::vector<std::uint8_t> there_;  // by candidate
    std::vector<std::uint8_t> kept_;   // by piece: the proof speaks of it
    std::vector<std::vector<std::int32_t>> covered_by_;
    std::vector<std::int32_t> root_;
    std::vector<std::uint8_t> in_root_;
    std::vector<std::int8_t> known_;            // by candidate: 1 chosen, -1 left out
    std::vector<std::int64_t> x_;               // sums by candidate
    std::vector<std::int64_t> r_;               // likewise
    std::vector<std::vector<std::int64_t>> y_;  // by candidate, as its list of near ones
    std::vector<std::uint8_t> mark_;
};

}  // namespace vfplan
