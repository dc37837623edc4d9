// Pieces of wall, and which of them a station covers (eq. 1, docs/method.md 4).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/view.h"

namespace vfplan {

// Every free side of every wall that has to be scanned, cut into equal pieces, numbered by wall,
// then side (left first), then from wall.a on. A county has twenty million, so what can be reckoned
// from the side is not stored.
class Pieces {
public:
    // The next wall's sides, with as many pieces each.
    void add_wall(double length_m, std::int32_t on_left, std::int32_t on_right);

    std::int64_t size() const { return first_.back(); }
    std::int64_t walls() const { return static_cast<std::int64_t>(length_m_.size()); }
    double wall_length_m(std::int32_t wall) const {
        return length_m_[static_cast<std::size_t>(wall)];
    }
    // Of a side of a wall: its first piece, and how many it has.
    std::int32_t first(std::int32_t wall, Side side) const { return first_[face(wall, side)]; }
    std::int32_t count(std::int32_t wall, Side side) const {
        return first_[face(wall, side) + 1] - first_[face(wall, side)];
    }
    // Of a piece, in time O(log walls): where it is, and where it begins and ends along its wall.
    struct Place {
        std::int32_t wall = 0;
        Side side = left;
        double s0_m = 0;
        double s1_m = 0;
    };
    Place place(std::int64_t piece) const;
    double length_m(std::int64_t piece) const;

private:
    static std::size_t face(std::int32_t wall, Side side) {
        return 2 * static_cast<std::size_t>(wall) + side;
    }
    std::vector<std::int32_t> first_ = {0};  // piece of each face, and one behind the last
    std::vector<double> length_m_;           // of each wall
};

// Where piece k of n lies along a wall of this length.
inline double piece_begin_m(double wall_length_m, std::int32_t k, std::int32_t n) {
    return wall_length_m * k / n;
}

// n = max(1, ceil(length / partition_m)).
std::int32_t pieces_along(double length_m, double partition_m);
// That many on each free side of each wall that has to be scanned.
Pieces cut_into_pieces(const std::vector<Wall>& walls, double partition_m);

// The length of every piece.
std::vector<double> piece_lengths_m(const Pieces& pieces);

// One piece as one station sees it. Floats, because that is what the table on disk keeps and a
// plan made from the table must be the same plan.
struct Seen {
    std::int32_t piece = 0;
    float fraction = 0;   // of the piece's length
    float angle_rad = 0;  // that its visible part takes
};

// A row of the coverage table: pieces with C = 1, ascending.
using CoverageRow = std::vector<Seen>;

// C = 1 iff at least `visible_fraction` of the piece's length is observed. Everything observed
// at all is returned when visible_fraction is 0. A tolerance of 1e-9 absorbs rounding. Without
// `angles`, a third of the work, all angle_rad are 0.
CoverageRow coverage_row(const std::vector<Wall>& walls, const Pieces& pieces, const Vec2d& eye,
                         const View& observed, double visible_fraction, bool angles = true);

// The table: row i = pieces that candidate i covers, as compressed sparse rows.
struct CoverageTable {
    std::vector<std::int64_t> begin = {0};  // rows() + 1 offsets into `seen`
    std::vector<Seen> seen;

    std::int64_t rows() const { return static_cast<std::int64_t>(begin.size()) - 1; }
    void add(const CoverageRow& row);
};

}  // namespace vfplan
