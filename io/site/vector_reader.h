// The door to GDAL for reading: any vector format that it knows.
#pragma once

#include <filesystem>
#include <string>

#include "io/site/feature.h"
#include "io/site/roles.h"

namespace vfplan {

struct ReadOptions {
    SiteKind kind = SiteKind::outdoor;
    // Empty: the only one, or all of a DXF, or the polygons of OSM data. For DXF: words, parted
    // by commas, of which a layer's name must contain one.
    std::string layer;
    std::string crs;    // "": as it is; "utm": the zone of the site; else a CRS that PROJ knows
    double unit_m = 1;  // metres per unit of the file
};

// Reads a whole file into memory, coordinates in metres.
// Throws IoError when the file cannot be opened; InputError when it is empty or no vector data,
// has several layers and none was named, is in degrees or feet and no crs was given, or has
// coordinates that are no numbers.
FeatureSet read_features(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace vfplan
