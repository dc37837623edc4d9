// The plan as plain text for other programs: CSV and GeoJSON, in the input's coordinates, and the
// proof of its bound (docs/file_format.md).
#pragma once

#include <span>
#include <string>

#include "io/exports/outputs.h"

namespace vfplan {

// stations.geojson, stations.csv, links.csv, pieces.csv, certificate.txt.
std::span<const Output> text_outputs();

}  // namespace vfplan
