// What it is worth to cover a piece.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/graphs/sparse.h"

namespace vfplan {

// Weights of pieces, in parts of proof_scale: their sum, less what rows cover beyond 1, is nearly
// the largest (docs/method.md, "Pool"). So a point that covers more than 1 promises to save
// stations.
// `rows`: pieces by candidate, ascending. Pieces that the same candidates cover weigh alike; what
// no row covers weighs nothing. Follows from its arguments alone.
std::vector<std::int64_t> weigh_pieces(const Sparse& rows, std::int64_t pieces);

}  // namespace vfplan
