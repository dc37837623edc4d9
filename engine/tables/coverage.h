// The coverage table (eq. 1, docs/method.md 4).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/field_tiles.h"

namespace vfplan {

// A phase, "coverage" or "pool": shards/PHASE-NUMBER.h5 with the rows of some thousand candidates
// each, the same blocks whatever the tiles. Gives their files.
std::vector<std::filesystem::path> make_coverage(const TableJob& job, const FieldTiles& field,
                                                 const std::string& phase,
                                                 const CandidateList& candidates);

}  // namespace vfplan
