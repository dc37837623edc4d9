// The parts of the overlap graph, found tile by tile.
#pragma once

#include "engine/candidate_tiles.h"
#include "engine/work.h"

namespace vfplan {

// work/pairs-TILE.h5 and work/parts-00000.h5: for each candidate of the list before links the part
// that it belongs to, numbered by their first candidate. Returns how many there are.
std::int64_t make_parts(const Work& work);

// The part of the candidates numbered [from, from + count).
std::vector<std::int32_t> read_parts(const Work& work, std::int64_t from, std::int64_t count);

}  // namespace vfplan
