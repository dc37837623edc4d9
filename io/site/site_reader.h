// From a file's features to a cleaned site: walls that meet at their ends only, with their free
// sides, and the region where stations may stand (docs/method.md 1).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/features/feature.h"
#include "io/site/openings.h"
#include "io/site/site_options.h"
#include "kernels/wall.h"

namespace vfplan {

struct SiteResult {
    Site site;
    std::vector<std::string> warnings;
    HowRead how;
    std::vector<OpeningStep> opening_steps;  // of a plan, if wanted
    std::vector<Vec2d> points;               // options.points in the input's metres
};

// Reads and cleans. Throws as read_features() does, and InputError for an invalid polygon (by
// its feature, reason and place), for no walls, and for no free space.
SiteResult read_site(const std::filesystem::path& file, const SiteOptions& options);

// The same from features in memory; `name` is used in messages.
SiteResult build_site(FeatureSet set, const SiteOptions& options, const std::string& name);

// Only what is drawn: the features of the crop by role, in the file's metres, not cleaned.
FeaturesByRole read_drawing(const std::filesystem::path& file, const SiteOptions& options);

// The border of the union of polygons, for even-odd tests.
std::vector<Border> border_of_union(const std::vector<Polygon>& polygons, double snap_m);

}  // namespace vfplan
