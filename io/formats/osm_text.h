// OpenStreetMap data in XML, before GDAL reads them: what it passes over in silence.
#pragma once

#include <filesystem>

#include "io/formats/gdal.h"

namespace vfplan {

// Throws InputError, with the line, for a latitude or longitude that is no number: GDAL takes it
// for 0. Reads the file once, part by part.
void check_osm(const PackedFile& packed, const std::filesystem::path& file);

}  // namespace vfplan
