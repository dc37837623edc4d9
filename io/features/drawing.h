// What a reader of a format gives: features as they are in the file, and what the file says of the
// unit and the place of their coordinates. read_features() makes metres of it.
#pragma once

#include "io/features/crs.h"
#include "io/features/feature.h"
#include "io/features/units.h"

namespace vfplan {

struct Drawing {
    FeatureSet set;  // coordinates in the file's unit
    Unit unit;
    DeclaredCrs crs;
};

}  // namespace vfplan
