// Towns and cities: walls, their free sides and the free region from features.
#pragma once

#include "io/features/feature.h"
#include "io/site/site_options.h"
#include "kernels/wall.h"

namespace vfplan {

// Polygons are solid, the ground around them is free. Lines (fences, free-standing walls) have
// two free sides, and what of them runs inside a solid is dropped. Group by group of what touches:
// a county at once would take gigabytes, and a single thread.
void build_outdoor(const FeaturesByRole& in, const SiteOptions& options, Site& site);

}  // namespace vfplan
