// A picture of a site as it was read: free ground, what was left out, walls by class and free side.
#pragma once

#include <string>

#include "kernels/wall.h"

namespace vfplan {

// A PNG image in memory, its longer side `pixels`. Ground is white where a station may stand, red
// where it was left out, grey elsewhere; walls are black, windows blue, doors orange, obstacles
// brown, with a green line along each side that is to be scanned. Throws IoError when the image
// library refuses.
std::string site_png(const Site& site, int pixels = 1600);

}  // namespace vfplan
