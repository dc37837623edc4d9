// Points off the ridges that would save stations (docs/method.md 6).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_shards.h"
#include "io/tables/field_tiles.h"

namespace vfplan {

struct PoolGrid {
    std::int32_t tried = 1;  // every so many cells, along both axes, a point is tried,
    std::int32_t taken = 0;  // and so many are taken as they are; 0: none
};

// The points of a window of cells, a square: those of the coarse grid that cover something, then,
// of those tried, one after the other that covers most by `weight` (of pieces, in parts of
// proof_scale) while it is more than 1, moved to where it covers more still; what it covers weighs
// less afterwards. `again`: points to try instead of those of the grid, as a round before gave
// them. `field` holds the window and grid.tried cells around. Thread-safe.
PoolSquare points_of(const TableJob& job, const FieldWindow& field, const Window& window,
                     const PoolGrid& grid, const std::vector<std::int64_t>& weight,
                     const CellRows* again = nullptr);

}  // namespace vfplan
