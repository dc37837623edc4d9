// Candidates along ridges: ends that cover something new, and middles where neighbours overlap too
// little (docs/method.md 3).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_shards.h"
#include "io/tables/ridge_shards.h"
#include "kernels/candidate.h"
#include "kernels/overlap.h"

namespace vfplan {

// Phase "splits": work/.../splits-NUMBER.h5. Ends of ridges that cover what no joint does; along
// every ridge, while two neighbours do not overlap enough, the arc's middle, down to 2 cells or
// depth 16. What the user's points cover is noted with their tile's. `pieces`: how many the site
// has.
FoundTiles make_splits(const TableJob& job, const RidgeTiles& ridges, const FoundTiles& joints,
                       const std::vector<Candidate>& of_user, const OverlapRule& rule,
                       std::int64_t pieces);

}  // namespace vfplan
