#include "engine/joining/row_store.h"

#include <utility>

#include "kernels/index.h"

namespace vfplan {

void PackedRows::add(std::span<const std::int32_t> pieces, std::span<const float> angle_rad,
                     std::int32_t first_piece) {
    for (const std::int32_t piece : pieces) add_piece(piece + first_piece, begin_.back(), runs_);
    begin_.push_back(runs_.size());
    entries_ += static_cast<std::int64_t>(pieces.size());
    angle_rad_.insert(angle_rad_.end(), angle_rad.begin(), angle_rad.end());
    entry_.push_back(angle_rad_.size());
}

void PackedRows::add(const PackedRows& others, std::size_t row) {
    for (const PieceRun& run : others.runs(row)) {
        runs_.push_back(run);
        entries_ += run.count;
    }
    begin_.push_back(runs_.size());
    angle_rad_.insert(angle_rad_.end(), others.angle_rad_.data() + others.entry_[row],
                      others.angle_rad_.data() + others.entry_[row + 1]);
    entry_.push_back(angle_rad_.size());
}

void PackedRows::keep(const std::vector<bool>& kept) {
    PackedRows out;
    for (std::size_t r = 0; r < kept.size(); ++r) {
        if (kept[r]) out.add(*this, r);
    }
    *this = std::move(out);
}

void PackedRows::unpack(std::size_t row, OverlapRows& to) const {
    for (const PieceRun& run : runs(row)) {
        for (std::int32_t k = 0; k < run.count; ++k) to.piece.push_back(run.first + k);
    }
    to.begin.push_back(static_cast<std::int64_t>(to.piece.size()));
    to.angle_rad.insert(to.angle_rad.end(), angle_rad_.data() + entry_[row],
                        angle_rad_.data() + entry_[row + 1]);
}

}  // namespace vfplan
