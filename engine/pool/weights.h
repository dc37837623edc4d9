// What it is worth to cover a piece.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/sparse.h"

namespace vfplan {

// Weights of pieces, in parts of proof_scale: nearly those with the largest sum of which no row
// covers more than 1 (docs/method.md 6). So a point that covers more than 1 would save stations.
// `rows`: pieces by candidate, ascending. Pieces that the same candidates cover weigh alike; what
// no row covers weighs nothing. Follows from its arguments alone.
std::vector<std::int64_t> weigh_pieces(const Sparse& rows, std::int64_t pieces);

}  // namespace vfplan
