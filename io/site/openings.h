// How the ground of a plan grows with site.max_opening_m, for `inspect`.
#pragma once

#include <vector>

#include "io/site/site_options.h"
#include "io/site/subdivision.h"

namespace vfplan {

// From this width of openings on so much is inside.
struct OpeningStep {
    double opening_m = 0;
    double inside_m2 = 0;
};

// The steps of the curve, up to `up_to_m`, that are at least 1 m2 and 1 % of the largest. A
// triangle is outside for all widths smaller than the narrowest gap on the widest way to it from
// outside: one search for widest paths gives them all. Empty where outlines or rooms say what is
// inside. `wall` and `shut` as for find_ground(); the subdivision needs feet as far as up_to_m.
std::vector<OpeningStep> opening_steps(const Subdivision& s, const std::vector<bool>& wall,
                                       const std::vector<bool>& shut, double snap_m,
                                       double up_to_m);

}  // namespace vfplan
