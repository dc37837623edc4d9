// Where on earth a file's coordinates are, and in which metres the site is.
#pragma once

#include <filesystem>
#include <string>

#include "io/features/feature.h"
#include "io/features/read_options.h"

namespace vfplan {

// How a file says where its coordinates are.
struct DeclaredCrs {
    std::string wkt;              // empty when it does not
    bool by_default = false;      // degrees by the format's standard, not by the file's own word
    bool always_project = false;  // a map in degrees by nature (OSM)
};

// Brings a set into metres. options.crs: empty, the coordinates stay; "utm" or a name, they are
// projected to that; of a file that says nothing and is in metres, options.crs tells what they are.
// Sets crs_wkt and from_degrees. Throws InputError for degrees or feet without options.crs and for
// coordinates that cannot be projected, UsageError for a CRS that is none or is not in metres.
void settle_crs(FeatureSet& set, const DeclaredCrs& declared, const ReadOptions& options,
                const std::filesystem::path& file);

// The definition of a code such as "EPSG:7415"; of one with heights only the plane part. Empty when
// there is none.
std::string wkt_of_code(const std::string& code);

// From the metres of a CRS, as WKT, to longitude and latitude (WGS 84); empty for an empty CRS and
// for one that has no way there. What it returns is not thread-safe.
std::function<Vec2d(const Vec2d&)> to_degrees(const std::string& wkt);

}  // namespace vfplan
