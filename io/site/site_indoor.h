// Floor plans: walls, their free sides and the free region from features.
#pragma once

#include "io/features/feature.h"
#include "io/site/openings.h"
#include "io/site/site_options.h"
#include "kernels/wall.h"

namespace vfplan {

// Free space is the outline when there is one, else the named rooms and the doorways between
// them, else what the walls enclose. Solids (thick walls, obstacles) and slits are
// taken out of it.
void build_indoor(const FeaturesByRole& in, const SiteOptions& options, Site& site);

// What would be inside for every site.max_opening_m up to a width (io/site/openings.h).
std::vector<OpeningStep> indoor_opening_steps(const FeaturesByRole& in, SiteOptions options,
                                              double up_to_m);

}  // namespace vfplan
