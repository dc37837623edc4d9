// The door to GDAL for writing: the plan as a GeoPackage for GIS programs.
#pragma once

#include <filesystem>

#include "io/exports/outputs.h"

namespace vfplan {

// Layers `stations` (points), `links` (lines with their overlap) and `pieces` (lines with their
// status), in the input's coordinates and CRS. Whole or not at all. Throws IoError.
void write_gpkg(const std::filesystem::path& path, const Results& results);

}  // namespace vfplan
