// Rows of cells in bulk: appended, thinned out and packed without a second copy.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/overlap_rows.h"

namespace vfplan {

// Appends a row, without its angles unless they are asked for; notes the lengths of its pieces.
void add_row(const OverlapRow& row, bool angles, OverlapRows& rows, std::span<double> length_m);

// Puts rows behind others, which are few; what is appended is not held twice.
void append(OverlapRows more, OverlapRows& rows);

// Drops the rows without kept[row], in place. They have no angles.
void keep(const std::vector<bool>& kept, OverlapRows& rows);

// Pieces that follow each other, as those of a wall that are seen mostly do.
struct PieceRun {
    std::int32_t first = 0;
    std::int32_t count = 0;
    auto operator<=>(const PieceRun&) const = default;
};
// Appends the next piece of a row whose runs begin at `row`.
inline void add_piece(std::int32_t piece, std::size_t row, std::vector<PieceRun>& runs) {
    if (runs.size() == row || runs.back().first + runs.back().count != piece) {
        runs.push_back({piece, 0});
    }
    ++runs.back().count;
}

// Rows in runs: a fraction of their size. Angles are kept as they are.
class PackedRows {
public:
    PackedRows() = default;
    // The rows from..end, pieces numbered from `first_piece`.
    PackedRows(const OverlapRows& rows, std::int32_t from, std::int32_t first_piece);
    // Appends a row to others.
    void unpack(std::size_t row, OverlapRows& to) const;

private:
    std::vector<PieceRun> runs_;
    std::vector<std::size_t> begin_ = {0};
    std::vector<float> angle_rad_;
    std::vector<std::size_t> entry_;  // of each row's first angle
};

}  // namespace vfplan
