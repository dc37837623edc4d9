// Candidates: joints, ridge points, rescue points and links, each with its coverage row (SPEC
// sections 3 and 4).
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "engine/viewer.h"
#include "kernels/candidate.h"
#include "kernels/overlap.h"
#include "kernels/ridges.h"

namespace vfplan {

struct CandidateOptions {
    OverlapRatio ratio = OverlapRatio::mean_len;
    double threshold = 0.3;
    std::vector<Vec2d> required;  // site frame
    std::vector<Vec2d> existing;
};

// Where candidates may lie. References to what outlives the builder.
struct Ground {
    const Grid& grid;
    const Raster<float>& field;             // NaN where no station can stand
    const Raster<std::uint8_t>& standable;  // cells where a station may stand
    const Raster<std::uint8_t>& closed;     // links between them that walls part
    const Raster<std::uint8_t>& domain;     // no closed link, and VF above the threshold
};

struct CandidateReport {
    std::int64_t joints = 0;
    std::int64_t ridges = 0;
    std::int64_t ridges_short_of_overlap = 0;  // split as far as it goes and still below
    std::int64_t rescued_pieces = 0;
    std::int64_t parts_before_links = 0;  // components of the overlap graph
    std::int64_t parts = 0;
};

struct CandidateResult {
    std::vector<Candidate> candidates;  // by y, then x; the user's points last, as given
    CoverageTable table;
    std::vector<PieceStatus> reach;  // covered = by some candidate; else why not
    CandidateReport report;
};

// Deterministic for any number of threads. `progress` hears a phase's name when it begins.
CandidateResult find_candidates(const Viewer& viewer, const Threads& threads, const Ground& ground,
                                const RidgeGraph& graph, const CandidateOptions& options,
                                const std::function<void(const char*)>& progress);

// --- parts shared by candidates.cpp, rescue.cpp and links.cpp ------------------------------------

// The candidates found so far, by cell.
class CandidatePool {
public:
    CandidatePool(const Viewer& viewer, const Threads& threads, const Ground& ground)
        : viewer_(viewer), threads_(threads), ground_(ground) {}

    // Adds the cells that are not in it yet. Rows are computed in parallel.
    void add(const std::vector<std::int64_t>& cells, CandidateKind kind);
    // Adds points of the user.
    void add_points(const std::vector<Vec2d>& points, CandidateKind kind);
    // Adds one that has been looked from already, unless its cell is there. cell -1: no cell's
    // centre.
    void add_seen(const Vec2d& point, std::int64_t cell, CandidateKind kind, CoverageRow row,
                  float vf_rad);
    bool has(std::int64_t cell) const { return index_.contains(cell); }
    const CoverageRow& row_at(std::int64_t cell) const { return rows_[index_.at(cell)]; }
    const std::vector<Candidate>& candidates() const { return candidates_; }
    const std::vector<CoverageRow>& rows() const { return rows_; }
    std::vector<std::uint8_t> covered() const;  // by piece

    const Viewer& viewer() const { return viewer_; }
    const Threads& threads() const { return threads_; }
    const Ground& ground() const { return ground_; }

private:
    const Viewer& viewer_;
    const Threads& threads_;
    const Ground& ground_;
    std::vector<Candidate> candidates_;
    std::vector<CoverageRow> rows_;
    std::unordered_map<std::int64_t, std::size_t> index_;
};

// A line of cells whose two ends are candidates.
using CellPath = std::vector<std::int64_t>;

// Ridge splitting: while two neighbours along a path overlap less than the threshold, the arc's
// middle is inserted, down to 2 cells or depth 16. Returns how many paths end short of it.
std::int64_t split_paths(CandidatePool& pool, const std::vector<CellPath>& paths,
                         const CandidateOptions& options);

// For each piece without a candidate: a free cell that sees enough of it becomes one. Returns
// the reach of every piece afterwards.
std::vector<PieceStatus> rescue_pieces(CandidatePool& pool, CandidateReport& report);

// Joins parts of the overlap graph along the shortest ways between them over cells that see
// anything: points are inserted as in ridge splitting, and between two cells' centres down to
// least_step_m. Ways on which some neighbours stay apart all the same add nothing.
inline constexpr double least_step_m = 0.05;
void link_parts(CandidatePool& pool, const CandidateOptions& options, CandidateReport& report);

}  // namespace vfplan
