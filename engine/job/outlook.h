// How far one sees on a site: a few views from its walls.
#pragma once

#include "engine/runtime/parallel.h"
#include "kernels/wall.h"

namespace vfplan {

struct Outlook {
    double sight_m = 0;  // mean distance of what is seen, by angle; the range where nothing is
    double spans = 0;    // stretches of wall in a view
};

// Looks from before walls that are spread evenly over the length of all free sides. Work is bounded
// by counts: sixteen views, each among the nearest few thousand walls. REQUIRES: a wall.
Outlook look_around(const Site& site, double range_m, const Threads& threads);

}  // namespace vfplan
