// Where a site lies: its coordinate reference system and the origin of its frame.
#pragma once

#include <string>

#include "io/h5_reader.h"
#include "io/h5_writer.h"
#include "kernels/vec.h"

namespace vfplan {

// As CF-1.8 has it, in a dataset `crs`.
void write_crs(h5::Writer& file, const std::string& crs_wkt, const Vec2d& origin);
std::string read_crs(const h5::Reader& file, Vec2d& origin);

// "EPSG:32633" from a CRS in WKT; empty when it names no such code.
std::string crs_name(const std::string& crs_wkt);

}  // namespace vfplan
