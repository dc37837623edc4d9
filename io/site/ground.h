// Where inside a building a station may stand, and which faces of walls can be seen from there
// (docs/method.md 1). Widths are those of edges between triangles: where walls come near each other
// the subdivision must have an edge across (see site_indoor.cpp), so that no gap is missed.
#pragma once

#include <vector>

#include "io/site/site_options.h"
#include "io/site/subdivision.h"

namespace vfplan {

struct Ground {
    std::vector<bool> free;  // by triangle: a station may stand there
    std::vector<bool>
        reached;  // by triangle: no wall parts it from free ground, so its faces count
    std::vector<bool> left_out;  // by triangle: inside, but no ground
    std::int64_t parts = 0;      // of free ground
    double area_m2 = 0;          // free
    std::vector<Dropped> dropped;
};

// What is inside: the outlines if there are any, else rooms and doorways, else all that the outside
// does not flow into. It flows through gaps wider than max_opening_m, and through no edge in `shut`
// (doors, windows). Between rooms, pieces up to max_gap_m2 count as inside too. Of the inside, what
// is left when it is cut where it is narrower than min_width_m is ground if it has min_room_m2 and
// a circle of that radius fits in. `wall` and `shut` are by edge of the subdivision.
Ground find_ground(const Subdivision& s, const std::vector<bool>& wall,
                   const std::vector<bool>& shut, const SiteOptions& options);

}  // namespace vfplan
