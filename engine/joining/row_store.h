// Rows of cells in bulk: packed, and thinned out so.
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/overlap_rows.h"

namespace vfplan {

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

// Rows in runs: a fraction of their size. Angles are kept as they are, of all rows or of none.
class PackedRows {
public:
    std::size_t size() const { return begin_.size() - 1; }
    std::int64_t entries() const { return entries_; }
    std::span<const PieceRun> runs(std::size_t row) const {
        return {runs_.data() + begin_[row], runs_.data() + begin_[row + 1]};
    }

    // Appends a row, pieces numbered from `first_piece`.
    void add(std::span<const std::int32_t> pieces, std::span<const float> angle_rad,
             std::int32_t first_piece = 0);
    // Appends a row of others.
    void add(const PackedRows& others, std::size_t row);
    // Drops the rows without kept[row].
    void keep(const std::vector<bool>& kept);
    // Appends a row to others, in full.
    void unpack(std::size_t row, OverlapRows& to) const;

private:
    std::vector<PieceRun> runs_;
    std::vector<std::size_t> begin_ = {0};
    std::int64_t entries_ = 0;
    std::vector<float> angle_rad_;
    std::vector<std::size_t> entry_ = {0};  // of each row's first angle
};

}  // namespace vfplan
