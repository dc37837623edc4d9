// Boxes that lie so far from all others that what covers them is mostly empty.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/vec.h"

namespace vfplan {

struct Strays {
    std::vector<std::size_t> boxes;  // ascending; empty: none
    Box whole;                       // around all boxes
    Box rest;                        // around those that are no strays
    double times = 1;                // the area of the whole, in areas of the rest
};

// A few boxes are strays when the area that covers all boxes is more than ten times as large
// through them alone. They are found from outside inwards: again and again what lies beyond the
// widest empty strip, or the one box that reaches farthest, is left out, as long as that takes
// away a third at least of what is covered.
//  (1) empty boxes are no strays and cover nothing
//  (2) strays are one box, or at most a tenth of all
//  (3) of two boxes alone, the second is the stray
//  (4) what surrounds all the rest is its outline, no stray
//  (5) without the strays, the area is less than a tenth; `margin` belongs to it on every side
Strays find_strays(const std::vector<Box>& boxes, double margin);

}  // namespace vfplan
