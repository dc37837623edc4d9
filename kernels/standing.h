// Where a station may stand, point by point: what a user asks for by coordinates, not by cells.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "kernels/wall.h"

namespace vfplan {

// A point this near to a wall, in metres, counts as on it: coordinates are written to the
// millimetre.
inline constexpr double at_wall_m = 1e-6;

class Standing {
public:
    // REQUIRES: the site outlives this. `forbidden` is even-odd, in the site's frame, as
    // free_border is.
    Standing(const Site& site, std::vector<Border> forbidden);

    // Why no station can stand at a place of the site's frame; empty if one can. Time O(walls).
    std::string_view objection(const Vec2d& at) const;

    // A place near by where one can stand, a centimetre beside what is in the way and to the
    // millimetre; none if the nearest few hundred tries are no better. Time O(walls) a try.
    std::optional<Vec2d> nearest(const Vec2d& at) const;

private:
    const Site& site_;
    std::vector<Border> forbidden_;
};

}  // namespace vfplan
