// Candidates from the skeleton, tile by tile (SPEC section 3): joints, ridge points, ridge ends,
// points inserted for overlap, and rescue points.
//
// A row costs some twenty microseconds and a county's rows are gigabytes, so no phase keeps rows:
// it keeps which pieces they cover, and looks again where it needs more.
#pragma once

#include "engine/work.h"
#include "kernels/candidate.h"

namespace vfplan {

// A line of cells whose two ends are candidates.
using CellPath = std::vector<std::int64_t>;

// Which pieces of the site are covered so far.
using CoveredPieces = std::vector<bool>;

// work/seeds-TILE.h5: joints, middles of ridges without joint, two points of each ring.
void make_seeds(const Work& work);

// work/ridges-TILE.h5: ends of ridges that cover what no seed does; along every ridge, while two
// neighbours overlap less than the threshold, the arc's middle, down to 2 cells or depth 16; and
// the user's points.
void make_ridge_points(const Work& work);

// work/rescue-TILE.h5: for every piece of the tile that nothing covers yet, the best cell that sees
// enough of it. Then work/candidates-0.h5: all of these, of rescue cells the fewest in the order of
// pieces.
void make_rescue(const Work& work);

// work/candidates-LIST.h5: candidates by patch, then row, then column; vf_rad is not kept. Points
// of the user are in no list: they are numbered behind it, in the order of the job.
inline constexpr std::int64_t found_list = 0;   // before links
inline constexpr std::int64_t linked_list = 1;  // with them
std::filesystem::path list_path(const Work& work, std::int64_t list);
// `parts` of the overlap graph is kept with it.
void write_list(const Work& work, std::int64_t list, std::vector<Candidate> candidates,
                std::int64_t parts = 0);
std::int64_t list_size(const Work& work, std::int64_t list);  // without the user's points
std::vector<Candidate> read_list(const Work& work, std::int64_t list, std::int64_t from,
                                 std::int64_t count);
// Those in a window's patches and the user's points there, with their numbers, ascending.
struct ListPart {
    std::vector<std::int32_t> number;
    std::vector<Candidate> candidates;
};
ListPart read_list(const Work& work, std::int64_t list, const Window& window);

// What happened on the way.
struct CandidateReport {
    std::int64_t joints = 0;
    std::int64_t ridges = 0;
    std::int64_t ridges_short_of_overlap = 0;  // split as far as it goes and still below
    std::int64_t rescued_pieces = 0;
    std::int64_t parts_before_links = 0;  // components of the overlap graph
    std::int64_t parts = 0;
};
void add_candidate_counts(const Work& work, CandidateReport& report);

// The user's points with their kind, as in the job.
std::vector<Candidate> points_of_user(const Work& work);

}  // namespace vfplan
