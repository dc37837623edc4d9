// Looking before computing: what a file or a job's site was read as.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/config/config.h"
#include "io/features/feature.h"

namespace vfplan {

struct Inspection {
    std::string text;     // for people
    std::string picture;  // PNG
};

// A bare site file, with the preset that fits it: indoor for drawings and for what has rooms,
// doors, windows or an outline, else outdoor; in degrees it is projected.
struct BareSite {
    Config config;
    std::optional<FeatureSet> features;  // as `config` reads them, when that is done already
};
// `sets` as --set has them; "preset=..." among them decides. Throws as read_features() does.
BareSite bare_site(const std::filesystem::path& file, const std::vector<std::string>& sets);

// Reads and cleans the site of a job, unless its features are given, and says how. Throws as a run
// would.
Inspection inspect(const Config& config, int threads, std::optional<FeatureSet> features = {});

}  // namespace vfplan
