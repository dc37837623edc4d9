// Features far off, through which a site covers far more ground than it has.
#pragma once

#include <string>

#include "io/features/feature.h"
#include "io/site/site_options.h"

namespace vfplan {

// One line for people about the features that find_strays() finds among those that make walls:
// which and where they are, how much the site shrinks without them, and what to do. Empty where
// there are none. Coordinates are the features'.
std::string stray_warning(const FeatureSet& set, const SiteOptions& options);

}  // namespace vfplan
