// The scan model (eq. 4; docs/method.md 2): 360 degrees, from range_min_m to range_max_m, up to the
// first wall, optionally only where the beam meets the wall steeply enough.
#pragma once

namespace vfplan {

struct Scanner {
    double range_min_m = 0.6;
    double range_max_m = 600;
    double max_incidence_deg = 90;  // between beam and wall normal; 90 means no limit but this:
};

// A wall that the beam meets at a smaller angle than this is seen edge-on: nothing of it is
// observed. Larger by far than what rounding makes of an eye in line with a wall, and far smaller
// than any scanner's beam: 75 nm beside a wall at 75 m.
inline constexpr double edge_on_rad = 1e-9;

}  // namespace vfplan
