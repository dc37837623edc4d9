// The plan as plain tables for other programs: CSV and GeoJSON, in the input's coordinates.
#pragma once

#include <filesystem>
#include <string>

#include "io/tables.h"

namespace vfplan {

// Texts of the run directory's files (docs/file_format.md); equal plans give equal bytes.
std::string stations_csv(const CoverageTables& tables, const Plan& plan);
std::string stations_geojson(const CoverageTables& tables, const Plan& plan);
std::string links_csv(const Plan& plan);

// pieces.csv, line by line: a county's is a gigabyte. Whole or not at all. Throws IoError.
void write_pieces_csv(const std::filesystem::path& file, const CoverageTables& tables,
                      const Plan& plan);

// "EPSG:32633" from a CRS in WKT; empty when it names no such code.
std::string crs_name(const std::string& crs_wkt);

}  // namespace vfplan
