// What the leader knows of a site's candidates and pieces while networks are joined.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/path_shards.h"
#include "io/tables/site_store.h"
#include "kernels/weak_view.h"

namespace vfplan {

template <class T>
void sort_once(std::vector<T>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

// A piece and a component that covers it.
using PieceComponent = std::pair<std::int32_t, std::int32_t>;

// Of all candidates, each once, ascending. `component` of each candidate. Memory is that of some
// thousand rows and of what it gives.
std::vector<PieceComponent> pieces_of_components(const TableJob& job,
                                                 const CandidateList& candidates,
                                                 const std::vector<std::int32_t>& component);

// The candidates that cover any piece of some, with their rows, ascending.
struct CandidateRows {
    std::vector<std::int32_t> number;
    std::vector<OverlapRow> rows;
};
CandidateRows candidates_covering(const TableJob& job, const CandidateList& candidates,
                                  const std::vector<bool>& pieces);

// For each piece the space that it lies in: what is seen from one space is never seen from another
// (kernels/weak_view.h). Spaces of patches are one where they have a side of a wall in common.
std::vector<std::int32_t> spaces_of_pieces(const TableJob& job, const SiteStore& site,
                                           const Pieces& pieces);

// From where the pieces of a patch may be seen, in its frame.
WeakView weak_view(const TableJob& job, const PatchSite& near, std::int64_t patch);

}  // namespace vfplan
