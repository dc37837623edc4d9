// The skeleton of the field, and what it is made of: joints and ridges (docs/method.md 3).
#pragma once

#include "engine/tables/shards.h"
#include "io/tables/field_tiles.h"
#include "io/tables/ridge_shards.h"

namespace vfplan {

// Cells beyond the scanner's range that a tile is thinned with, at first.
inline constexpr std::int32_t skeleton_margin_cells = 48;

// What a tile holds while it is thinned; `range_cells`: the scanner's range.
double skeleton_task_bytes(const Layout& layout, double range_cells);

// Phase "skeleton": work/.../skeleton-NUMBER.h5. The same cells as if the whole grid had been
// thinned at once: a tile is thinned with so much around it that the fate of each of its cells is
// certain.
SkeletonTiles make_skeleton(const TableJob& job, const FieldTiles& field, double threshold_rad);

// Phase "ridges": work/.../ridges.h5, on the leader.
RidgeTiles make_ridges(const TableJob& job, const SkeletonTiles& skeleton);

}  // namespace vfplan
