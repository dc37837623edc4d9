// From where a piece is best covered, when no ridge sees it (docs/method.md 4).
#pragma once

#include <cstdint>

#include "engine/tables/shards.h"
#include "io/tables/field_tiles.h"
#include "kernels/coverage.h"

namespace vfplan {

struct BestCell {
    std::int64_t cell = -1;  // of the whole grid; -1: none covers the piece
    CoverageRow row;         // what it covers
};

// The first good cell, tried by real views: inside the domain first, and there first those that see
// every sample point of the piece, which are nearly certain; of these the greatest VF. `piece` is
// the scene's, `field` reaches a range around it. Thread-safe.
BestCell best_cell(const TableJob& job, const Scene& scene, const FieldWindow& field,
                   double threshold_rad, std::int32_t piece);

}  // namespace vfplan
