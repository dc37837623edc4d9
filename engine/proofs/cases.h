// A proof by cases: the relaxation of a problem made tighter, then divided.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/proofs/broken_lines.h"
#include "engine/proofs/effort.h"
#include "engine/proofs/relaxation.h"
#include "engine/proofs/weighing.h"

namespace vfplan {

// The tree of cases over one relaxation. Refers to the lines. Belongs to one thread.
class Cases {
public:
    // `plan` is one of the problem's; `start` are lines to begin with.
    Cases(Lines& lines, const Choice& plan, bool ways, const std::vector<ProofLine>& start);

    // Goes on until no better plan is left or the effort is spent. Without `divide` the whole
    // problem stays the only case, and it ends where new lines help no more, too.
    void run(Effort& effort, bool divide);

    // Stations of any plan, at least.
    std::int64_t bound() const;
    std::int64_t value() const;  // of the weakest case, in parts of proof_scale
    bool is_closed() const { return bound() >= static_cast<std::int64_t>(plan_.size()); }
    // The best plan that was met.
    const Choice& plan() const { return plan_; }
    // Lines and cases of the proof, lines that weigh nothing left out.
    void write(NetworkProof& out) const;
    // Lines that weigh something in the first case.
    std::vector<ProofLine> lines_of_first() const;
    std::size_t cases() const { return tree_.size(); }

private:
    struct Case {
        std::int32_t parent = -1;
        std::int32_t column = -1;  // what was divided by to get here,
        Known known = Known::free;
        std::int32_t child = -1;  // the first of two
        bool tried = false;
        std::int64_t value = 0;
        std::vector<LineWeight> weights;
    };

    void enter(std::int32_t number);
    // Solves and adds broken lines again and again.
    void tighten(std::int32_t number, Effort& effort, std::int64_t rounds);
    bool add_lines(Effort& effort);
    void look_for_plan();
    void try_plan(const Choice& choice);
    std::int32_t column_to_divide_by() const;
    void divide(std::int32_t number);
    bool is_open(const Case& c) const {
        return c.child < 0 && stations_of(c.value) < static_cast<std::int64_t>(plan_.size());
    }

    Lines& lines_;
    const Problem& p_;
    bool ways_;
    Choice plan_;
    Relaxation relaxation_;
    BrokenLines broken_;
    Weighing weighing_;
    std::vector<Case> tree_;
    std::vector<Known> known_;  // in the case that the relaxation is at
};

}  // namespace vfplan
