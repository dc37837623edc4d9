// The shortest paths between components of the overlap graph, over cells that see anything
// (docs/method.md 6).
#pragma once

#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/candidate_list.h"
#include "io/tables/field_tiles.h"
#include "io/tables/path_shards.h"

namespace vfplan {

// Beyond this far from a candidate, in ranges of the scanner, no path is looked for.
inline constexpr double paths_reach_ranges = 4;
// Paths tried between two components, the shortest first, each between two other candidates.
inline constexpr std::size_t paths_tried = 4;

// What a block of cells holds while paths are looked for; `range_cells`: the scanner's range.
double paths_task_bytes(const Layout& layout, double range_cells);

// Phase "paths": work/.../paths-NUMBER.h5, those that meet in a block of cells, and paths.h5. None
// where there is one component.
std::vector<ShortestPath> make_paths(const TableJob& job, const FieldTiles& field,
                                     const CandidateList& candidates, const Components& components);

}  // namespace vfplan
