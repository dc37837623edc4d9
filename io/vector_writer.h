// The door to GDAL for writing: the plan as a GeoPackage for GIS programs.
#pragma once

#include <filesystem>

#include "io/tables.h"

namespace vfplan {

// Layers `stations` (points), `links` (lines with their overlap) and `pieces` (lines with their
// status), in the input's coordinates and CRS. Whole or not at all. Throws IoError.
void write_gpkg(const std::filesystem::path& file, const CoverageTables& tables, const Plan& plan);

}  // namespace vfplan
