// The site once more from its file, by other means than those that cleaned it.
#pragma once

#include <string>
#include <vector>

#include "engine/config/config.h"
#include "io/tables/coverage_file.h"

namespace vfplan {

struct Reread {
    bool good = true;
    std::vector<std::string> text;  // one line a check
};

// Unites what is drawn with GEOS and compares: the length of all walls, and a sample
// of faces, of which a free one must not look into a solid. Reading the file and telling roles are
// shared with the reader, cleaning is not. Throws as read_features() does.
Reread reread(const Config& config, const CoverageTables& tables);

}  // namespace vfplan
