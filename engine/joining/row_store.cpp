#include "engine/joining/row_store.h"

#include "kernels/index.h"

namespace vfplan {

void add_row(const OverlapRow& row, bool angles, OverlapRows& rows, std::span<double> length_m) {
    const SeenRow seen = row.seen();
    rows.piece.insert(rows.piece.end(), seen.piece.begin(), seen.piece.end());
    if (angles) {
        rows.angle_rad.insert(rows.angle_rad.end(), seen.angle_rad.begin(), seen.angle_rad.end());
    }
    rows.begin.push_back(static_cast<std::int64_t>(rows.piece.size()));
    for (std::size_t i = 0; i < seen.piece.size(); ++i) {
        length_m[idx(seen.piece[i])] = seen.length_of(i);
    }
}

void append(OverlapRows more, OverlapRows& rows) {
    more.piece.insert(more.piece.begin(), rows.piece.begin(), rows.piece.end());
    more.angle_rad.insert(more.angle_rad.begin(), rows.angle_rad.begin(), rows.angle_rad.end());
    const std::int64_t behind = rows.entries();
    for (std::size_t i = 1; i < more.begin.size(); ++i) {
        rows.begin.push_back(behind + more.begin[i]);
    }
    more.begin = std::move(rows.begin);
    rows = std::move(more);
}

void keep(const std::vector<bool>& kept, OverlapRows& rows) {
    std::size_t count = 0;
    std::size_t end = 0;
    for (std::size_t r = 0; r < kept.size(); ++r) {
        const auto from = idx(rows.begin[r]);
        const auto to = idx(rows.begin[r + 1]);
        if (!kept[r]) continue;
        for (std::size_t i = from; i < to; ++i) rows.piece[end++] = rows.piece[i];
        rows.begin[++count] = static_cast<std::int64_t>(end);
    }
    rows.begin.resize(count + 1);
    rows.piece.resize(end);
}

PackedRows::PackedRows(const OverlapRows& rows, std::int32_t from, std::int32_t first_piece) {
    for (std::int32_t r = from; r < rows.size(); ++r) {
        for (const std::int32_t piece : rows.row(r)) {
            add_piece(piece + first_piece, begin_.back(), runs_);
        }
        begin_.push_back(runs_.size());
    }
    if (rows.angle_rad.empty()) return;
    const auto first = rows.begin[idx(from)];
    angle_rad_.assign(rows.angle_rad.begin() + first, rows.angle_rad.end());
    for (std::int32_t r = from; r <= rows.size(); ++r) {
        entry_.push_back(idx(rows.begin[idx(r)] - first));
    }
}

void PackedRows::unpack(std::size_t row, OverlapRows& to) const {
    for (std::size_t i = begin_[row]; i < begin_[row + 1]; ++i) {
        for (std::int32_t k = 0; k < runs_[i].count; ++k) {
            to.piece.push_back(runs_[i].first + k);
        }
    }
    to.begin.push_back(static_cast<std::int64_t>(to.piece.size()));
    if (entry_.empty()) return;
    to.angle_rad.insert(to.angle_rad.end(), angle_rad_.data() + entry_[row],
                        angle_rad_.data() + entry_[row + 1]);
}

}  // namespace vfplan
