// The plan as plain tables for other programs: CSV and GeoJSON, in the input's coordinates
// (docs/file_format.md).
#pragma once

#include <span>
#include <string>

#include "io/exports/outputs.h"

namespace vfplan {

// stations.geojson, stations.csv, links.csv, pieces.csv.
std::span<const Output> text_outputs();

}  // namespace vfplan
