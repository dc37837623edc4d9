// Which parts of a site touch each other.
#pragma once

#include <vector>

#include "kernels/vec.h"

namespace vfplan {

// Groups of boxes that come within `near_m` of each other, directly or over others, each ascending.
// What is further apart than a few snaps meets in no noding, so groups may be worked on one by one.
// Empty boxes are in none. Thread-safe.
std::vector<std::vector<std::size_t>> neighbour_groups(const std::vector<Box>& boxes,
                                                       double near_m);

}  // namespace vfplan
