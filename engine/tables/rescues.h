// Candidates for walls that no ridge sees (docs/method.md 4).
#pragma once

#include <cstdint>
#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/candidate_shards.h"
#include "io/tables/field_tiles.h"
#include "io/tables/site_store.h"

namespace vfplan {

// Phase "rescues": for every piece that neither joints nor splits cover the best cell that sees
// enough of it, in the order of docs/method.md 4, unless the cell of a piece before covers it;
// `threshold_rad` bounds the domain: work/.../rescues-NUMBER.h5. Then the list of all candidates
// that there are by then: work/.../rescues.h5.
CandidateList make_rescues(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                           const FoundTiles& joints, const FoundTiles& splits,
                           const std::vector<Candidate>& of_user, double threshold_rad);

}  // namespace vfplan
