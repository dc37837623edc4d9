// Smaller problems that stand for larger ones.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/problem.h"

namespace vfplan {

// A column that went because another stands for it. In their order, each step is right in what the
// steps before it left: `by` covers all rows that `gone` covers (of those that stay in the end) and
// is near to all that `gone` is near to.
struct GoneColumn {
    std::int32_t gone = 0;
    std::int32_t by = 0;
};

// A problem with as few columns and rows as stand for the whole.
struct Reduced {
    Problem problem;
    std::vector<std::int32_t> column;  // in the whole problem, of each column
    std::vector<std::int32_t> row;     // likewise
    std::vector<GoneColumn> gone;
};

// A plan of the reduced problem is one of the whole, and some best plan of the whole is among them.
// Fixed columns stay. REQUIRES: cycles do not count, where a column that adds nothing may still
// close one; the problem is no window.
Reduced reduce(const Problem& problem);

// Rows go by rows whose columns all cover them as well: those that stay, ascending; of equal ones
// the first.
std::vector<std::int32_t> needed_rows(const Problem& problem);

// The same choice in a reduced problem: what went is replaced by what stands for it. `columns`: of
// the whole problem.
Choice reduced_choice(const Reduced& reduced, std::int32_t columns, const Choice& whole);

}  // namespace vfplan
