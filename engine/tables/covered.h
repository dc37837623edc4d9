// Which pieces of wall some points cover.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/tables/shards.h"

namespace vfplan {

// One bit for each piece of the site.
using CoveredPieces = std::vector<bool>;

// The pieces that some eyes cover, ascending. `pieces`: how many the site has. Memory is that of
// some hundred rows and a bit a piece.
std::vector<std::int32_t> covered_from(const TableJob& job, const std::vector<Vec2d>& eyes,
                                       std::int64_t pieces);

// The centres of cells.
std::vector<Vec2d> centres(const Grid& grid, const std::vector<std::int64_t>& cells);

}  // namespace vfplan
