// A site's file, whatever its format: features by role, in metres.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/features/feature.h"
#include "io/features/read_options.h"

namespace vfplan {

// Reads a whole file into memory. Formats are told by content, not by name (docs/formats.md): JSON
// of three kinds, XML of two, AGPLIB, ROS maps, and what GDAL reads; gzip'd or in a ZIP archive.
// Throws IoError when the file cannot be opened; InputError when it is empty, damaged or no site,
// has several layers and none was named, is in degrees or feet and no crs was given, or has
// coordinates that are no numbers or no places; UsageError for options that the format has no
// meaning for.
// Nothing is read but the files of input_files(), and nothing is fetched from the network, unless
// options.allow_network: InputError for a file that leads to others or to an address.
FeatureSet read_features(const std::filesystem::path& file, const ReadOptions& options);

// Every file that a site consists of: what was given; what GDAL reads with it (the siblings of a
// Shapefile, the files of a folder, where the network is allowed the targets of a virtual file);
// the image of a ROS map; of a geodatabase's folder (.gdb) all files below it. Of packed sites the
// archive. Absolute, sorted, each once. A file that is read through the network has the name that
// GDAL opens (/vsicurl/...). Throws as read_features() does for what is not there, and InputError
// where a service is asked, or what is named cannot be opened: what cannot be hashed.
std::vector<std::filesystem::path> input_files(const std::filesystem::path& input,
                                               bool allow_network = false);

// Whether such a file is read through the network.
bool is_remote(const std::filesystem::path& file);

// SHA-256 of the contents of such files in their order: of one file its own, of several that of
// their hashes. Names do not count. Throws IoError when one cannot be read.
std::string input_sha256(const std::vector<std::filesystem::path>& files);

}  // namespace vfplan
