// Better weights where a problem is too large for one linear program.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/proofs/effort.h"
#include "engine/proofs/lines.h"

namespace vfplan {

// Makes the weights of `cover` lines better, window by window: a ball of columns with the rows that
// these alone cover is a problem of its own, in which a column costs what lines that reach out of
// the window leave of it. Its linear program gives new weights of these rows and of `nodes` lines,
// which replace those before where they prove more. Each window adds to the bound and takes nothing
// from others. `weight`: of each row. Lines and weights of the result, as Weighing has them.
struct Weighed {
    std::vector<ProofLine> lines;
    std::vector<LineWeight> weights;
};
Weighed weigh_by_windows(const Problem& problem, const Root& root,
                         const std::vector<std::int64_t>& weight, Effort& effort);

}  // namespace vfplan
