// Occupancy maps of robots (ROS map_server, Nav2): a YAML file and the image that it names.
#pragma once

#include <filesystem>
#include <string>

#include "io/features/drawing.h"
#include "io/features/read_options.h"

namespace vfplan {

// Whether a text begins as such a file: it names an image and a resolution, or an image and is YAML
// by its name.
bool looks_like_ros_map(const std::string& head, const std::filesystem::path& file);

// Occupied pixels become walls, free ones rooms, both traced by potrace to polygons that stay
// within half a pixel of the pixels' border; specks of two pixels are left out, with a warning.
// Unknown pixels are neither: stations do not stand there, and nobody scans their border. Throws
// InputError for YAML that is damaged or lacks something, and as read_grey_image() does.
Drawing read_ros_map(const std::string& text, const std::filesystem::path& file,
                     const ReadOptions& options);

}  // namespace vfplan
