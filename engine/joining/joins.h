// Networks joined over all free cells, and what remains apart with its proof (docs/method.md 6).
#pragma once

#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/field_tiles.h"
#include "io/tables/join_shards.h"
#include "io/tables/site_store.h"
#include "kernels/overlap.h"

namespace vfplan {

struct Joins {
    CandidateList candidates;  // all that there are
    Apart apart;               // on the leader; empty where there is one component
};

// Phase "joins": work/.../joins.h5, the candidates with those that join components of the overlap
// graph over all free cells, by the shortest chains, and those over which a component covers what
// else a lesser one is needed for; and work/.../apart.h5, how far the components are apart. Before
// it, round by round, phase "disputed": work/.../disputed-ROUND.h5, which pieces are seen from
// which component, and its shards (engine/joining/disputes.h). Nothing of it where there is one
// component.
Joins make_joins(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                 const CandidateList& candidates, const std::vector<Candidate>& of_user,
                 const OverlapRule& rule);

}  // namespace vfplan
