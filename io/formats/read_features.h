// A site's file, whatever its format: features by role, in metres.
#pragma once

#include <filesystem>

#include "io/features/feature.h"
#include "io/features/read_options.h"

namespace vfplan {

// Reads a whole file into memory. Formats are told by content, not by name (docs/formats.md): JSON
// of three kinds, XML of two, AGPLIB, ROS maps, and what GDAL reads; gzip'd or in a ZIP archive.
// Throws IoError when the file cannot be opened; InputError when it is empty, damaged or no site,
// has several layers and none was named, is in degrees or feet and no crs was given, or has
// coordinates that are no numbers or no places; UsageError for options that the format has no
// meaning for.
FeatureSet read_features(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace vfplan
