// The coverage table, block by block: shards/coverage-NUMBER.h5 with the rows of some thousand
// candidates each, the same blocks whatever the tiles.
#pragma once

#include "engine/candidate_tiles.h"
#include "engine/work.h"

namespace vfplan {

// Makes all blocks from the last list of candidates (SPEC section 4). Returns their number.
std::int64_t make_coverage_blocks(const Work& work);

// coverage.h5: the index over the blocks, and what is small enough to stand in one place. `summary`
// is kept in it for summary.json.
void write_coverage_tables(const Work& work, std::int64_t blocks, const std::string& summary);

// Pieces for which a rescue cell was found.
std::int64_t rescued_pieces(const Work& work);

}  // namespace vfplan
