// The linear relaxation of a problem: it grows by lines that its solution breaks.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/proofs/broken_lines.h"
#include "engine/proofs/effort.h"
#include "engine/proofs/lp.h"
#include "engine/proofs/weighing.h"

namespace vfplan {

// Without ways it knows columns only. With them it knows trees as well: ways come in as their
// reduced cost asks for them. `stations`: of a plan that is known; worse cases are cut off. Refers
// to all of these. Belongs to one thread.
class Relaxation {
public:
    Relaxation(Lines& lines, std::int64_t stations, bool ways);

    // The line gets the number of its place in lines().
    void add(ProofLine line);
    const std::vector<ProofLine>& lines() const { return all_; }
    void set_known(std::int32_t column, Known known);
    void set_stations(std::int64_t stations) { stations_ = stations; }

    // Solves; false when it stopped in between.
    bool solve(Effort& effort);
    double value() const { return lp_.value(); }
    const Fraction& at() const { return at_; }
    // What the rows weigh now, for Weighing.
    std::vector<LineWeight> weights() const;
    // Takes out rows that have not mattered for a while. After solve().
    void purge();

private:
    void put(std::int32_t line);
    void put_way(std::int64_t place);
    // Ways that would make the solution better; how many.
    std::size_t price(Effort& effort);
    void read();

    Lines& lines_;
    const Problem& p_;
    std::int64_t stations_;
    bool ways_;
    Lp lp_;
    std::vector<ProofLine> all_;
    std::vector<std::int32_t> line_of_row_;  // -1 where it says that a column has one way into it
    std::vector<std::int32_t> idle_;         // by row: for how many solutions it has been slack
    std::vector<std::int32_t> row_of_into_;  // by column
    std::vector<std::int32_t> lp_way_;       // column of the program by place, or -1
    std::vector<std::int32_t> head_;         // by place: the column that it leads into
    std::int32_t first_root_ = 0;            // column of the program
    std::int32_t relief_ = 0;                // likewise: fulfils every line, at a price
    std::vector<double> cost_;               // of ways, while they are priced
    Fraction at_;
};

}  // namespace vfplan
