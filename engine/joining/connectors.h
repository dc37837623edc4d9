// Candidates that join components of the overlap graph, along the shortest paths between them
// (docs/method.md 6).
#pragma once

#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/path_shards.h"
#include "kernels/overlap.h"

namespace vfplan {

// Between two cells' centres points are tried down to this distance.
inline constexpr double least_step_m = 0.05;

// Phase "connectors": which paths can be covered with points that overlap enough one after another,
// work/.../connectors-NUMBER.h5; points are inserted as in ridge splitting, and a path on which
// some neighbours stay apart all the same adds nothing. Then the list of all candidates, with the
// points of the shortest such paths that join what is apart: work/.../connectors.h5. (On none of
// our sites did a second round from the points so inserted join anything more.)
CandidateList make_connectors(const TableJob& job, const CandidateList& candidates,
                              const Components& components, const std::vector<ShortestPath>& paths,
                              const std::vector<Candidate>& of_user, const OverlapRule& rule);

}  // namespace vfplan
