// Lines that a fractional solution breaks.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/proofs/effort.h"
#include "engine/proofs/flow.h"
#include "engine/proofs/lines.h"
#include "engine/search/dice.h"

namespace vfplan {

// Values of the variables of a problem with a root.
struct Fraction {
    std::vector<double> x;  // by column
    std::vector<double> y;  // by place of a way; empty where ways are not looked at
    std::vector<double> r;  // by root candidate
};

// Refers to the lines. Not thread-safe.
class BrokenLines {
public:
    explicit BrokenLines(Lines& lines);

    // The most broken ones, at most so many of each.
    std::vector<ProofLine> covers(const Fraction& at, std::size_t most) const;
    std::vector<ProofLine> pairs(const Fraction& at, std::size_t most) const;
    // By least cuts, for rows (and, in the second, columns) drawn by lot, until there are so many.
    std::vector<ProofLine> nodes(const Fraction& at, std::size_t most, Effort& effort);
    std::vector<ProofLine> arcs(const Fraction& at, std::size_t most, Effort& effort);

private:
    // 0 .. count - 1, shuffled.
    std::vector<std::int32_t> drawn(std::int32_t count);

    Lines& lines_;
    const Problem& p_;
    Dice dice_;
    Flow by_way_;
    std::vector<std::int32_t> way_;  // edges by place
    std::vector<std::int32_t> root_;
    std::vector<std::int32_t> way_end_;
};

}  // namespace vfplan
