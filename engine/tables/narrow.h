// Ground that the clearance leaves to no station.
#pragma once

#include <string>
#include <vector>

#include "engine/config/options.h"
#include "engine/runtime/parallel.h"
#include "kernels/layout.h"
#include "kernels/wall.h"

namespace vfplan {

struct NarrowPlace {
    Vec2d at;  // of the site's frame: the middle of a row of its cells, that nearest to its centre
    double area_m2 = 0;
};

// Parts of the ground that lie farther than the clearance from wherever it lets a station stand, of
// site.min_room_m2 or more (corners of rooms are smaller); the largest first, then by place. None
// without a clearance. What the user forbids does not count. Memory: some bands of rows, and what
// they find.
std::vector<NarrowPlace> narrow_places(const GroundOptions& options, const Site& site,
                                       const Layout& layout, const Threads& threads);

double area_m2(const std::vector<NarrowPlace>& places);

// For people: how much it is in all, and the largest places, one a line.
std::string narrow_text(const std::vector<NarrowPlace>& places, const GroundOptions& options,
                        const Site& site);

}  // namespace vfplan
