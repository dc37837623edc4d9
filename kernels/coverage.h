// Pieces of wall, and which of them a station covers (eq. 1, SPEC section 4).
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/view.h"

namespace vfplan {

// Every free side of every wall that has to be scanned, cut into n = max(1, ceil(length /
// partition_m)) equal pieces, numbered by wall, then side (left first), then from wall.a on.
struct Pieces {
    std::vector<std::int32_t> wall;  // of each piece
    std::vector<std::uint8_t> side;  // Side of each piece
    std::vector<double> s0_m;        // where it begins and ends along its wall
    std::vector<double> s1_m;
    std::vector<std::int32_t> first_of;  // first piece of wall * 2 + side; -1 where none
    std::vector<std::int32_t> count_of;  // how many pieces that side has

    std::int64_t size() const { return static_cast<std::int64_t>(wall.size()); }
    double length_m(std::int64_t piece) const {
        const auto p = static_cast<std::size_t>(piece);
        return s1_m[p] - s0_m[p];
    }
};

Pieces cut_into_pieces(const std::vector<Wall>& walls, double partition_m);

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
// at all is returned when visible_fraction is 0. A tolerance of 1e-9 absorbs rounding.
CoverageRow coverage_row(const std::vector<Wall>& walls, const Pieces& pieces, const Vec2d& eye,
                         const View& observed, double visible_fraction);

// The table: row i = pieces that candidate i covers, as compressed sparse rows.
struct CoverageTable {
    std::vector<std::int64_t> begin = {0};  // rows() + 1 offsets into `seen`
    std::vector<Seen> seen;

    std::int64_t rows() const { return static_cast<std::int64_t>(begin.size()) - 1; }
    const Seen* row_begin(std::int64_t row) const {
        return seen.data() + begin[static_cast<std::size_t>(row)];
    }
    const Seen* row_end(std::int64_t row) const {
        return seen.data() + begin[static_cast<std::size_t>(row) + 1];
    }
    void add(const CoverageRow& row);
};

// For each piece the rows that cover it, ascending.
struct InvertedIndex {
    std::vector<std::int64_t> begin;
    std::vector<std::int32_t> row;
};

InvertedIndex invert(const CoverageTable& table, std::int64_t pieces);

}  // namespace vfplan
