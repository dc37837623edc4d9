// Looking before computing: what a file or a job's site was read as.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/config/config.h"

namespace vfplan {

struct Inspection {
    std::string text;     // for people
    std::string picture;  // PNG
};

// A configuration for a bare site file, with the preset that fits it: indoor for drawings and for
// what has rooms, doors, windows or an outline, else outdoor; in degrees it is projected. `sets` as
// --set has them; "preset=..." among them decides. Throws as read_features() does.
Config config_for_site(const std::filesystem::path& file, const std::vector<std::string>& sets);

// Reads and cleans the site of a job and says how. Throws as a run would.
Inspection inspect(const Config& config, int threads);

}  // namespace vfplan
