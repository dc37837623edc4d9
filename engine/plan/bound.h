// How few stations any plan over the candidates can have.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/overlap_rows.h"

namespace vfplan {

// Pieces no two of which share a candidate, greedily, ascending: each needs a station of its own,
// so their number is a lower bound (Plan::bound_pieces).
std::vector<std::int32_t> independent_pieces(const OverlapRows& rows, const PieceIndex& index);

}  // namespace vfplan
