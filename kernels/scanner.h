// The scan model (eq. 4; docs/method.md 2): 360 degrees, from range_min_m to range_max_m, up to the
// first wall, optionally only where the beam meets the wall steeply enough.
#pragma once

namespace vfplan {

struct Scanner {
    double range_min_m = 0.6;
    double range_max_m = 600;
    double max_incidence_deg = 90;  // between beam and wall normal; 90 means no limit
};

}  // namespace vfplan
