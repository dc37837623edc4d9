// The first candidates: where ridges meet, and what ridges without joints stand for
// (docs/method.md 3).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_shards.h"
#include "io/tables/ridge_shards.h"

namespace vfplan {

// The middle of a line, two opposite points of a ring; none for a ridge with a joint.
std::vector<std::int64_t> points_without_joint(const Grid& grid, const TileRidges::Line& ridge);

// Phase "joints": work/.../joints-NUMBER.h5. `pieces`: how many the site has.
FoundTiles make_joints(const TableJob& job, const RidgeTiles& ridges, std::int64_t pieces);

}  // namespace vfplan
