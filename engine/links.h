// Joins parts of the overlap graph along the shortest ways between them over cells that see
// anything (SPEC section 6, "densified where needed").
#pragma once

#include "engine/candidate_tiles.h"
#include "engine/work.h"

namespace vfplan {

// Beyond this far from a candidate, in ranges of the scanner, no way is looked for.
inline constexpr double ways_reach_ranges = 4;
// Between two cells' centres points are tried down to this distance.
inline constexpr double least_step_m = 0.05;
// Ways tried between two parts, the shortest first, each between two other candidates.
inline constexpr std::size_t ways_tried = 4;

// work/ways-, bridges- and the list of all candidates. Points are inserted on a way as in ridge
// splitting, and a way on which some neighbours stay apart all the same adds nothing. (On none of
// our sites did a second round from the points so inserted join anything more.)
void make_links(const Work& work, CandidateReport& report);

}  // namespace vfplan
