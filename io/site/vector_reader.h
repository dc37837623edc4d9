// The door to GDAL for reading: any vector format that it knows.
#pragma once

#include <filesystem>

#include "io/site/feature.h"
#include "io/site/site_options.h"

namespace vfplan {

// Reads a whole file into memory, coordinates in metres.
// Throws IoError when the file cannot be opened; InputError when it is empty or no vector data,
// has several layers and none was named, is in degrees or feet and no crs was given, or has
// coordinates that are no numbers.
FeatureSet read_features(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace vfplan
