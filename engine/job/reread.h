// The site once more from its file, by other means than those that cleaned it.
#pragma once

#include <string>
#include <vector>

#include "engine/config/config.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"

namespace vfplan {

struct Reread {
    bool good = true;
    std::vector<std::string> text;  // one line a check
};

// Unites what is drawn with GEOS and compares: the length of walls, outdoors by how many sides they
// have; the area that is solid, or free within outlines; a sample of cells, which must not be free
// in something solid nor (outdoors) taken beside it; a sample of faces, of which a free one must
// not look into something solid. Indoors without outlines nobody but the reader can say which
// ground is free. Without `field` cells are not looked at. Reading the file and telling roles are
// shared with the reader, cleaning is not. Throws as read_features() does.
Reread reread(const Config& config, const CoverageTables& tables, const FieldFile* field);

}  // namespace vfplan
