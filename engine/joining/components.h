// The components of the overlap graph, found tile by tile.
#pragma once

#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/path_shards.h"
#include "kernels/overlap.h"

namespace vfplan {

// Phase "components": work/.../components-NUMBER.h5, and components.h5 with the component of each
// candidate, numbered by their first candidate. `variant` behind "components" where it is done
// again for more candidates.
Components make_components(const TableJob& job, const CandidateList& candidates,
                           const OverlapRule& rule, const std::string& variant = "");

}  // namespace vfplan
