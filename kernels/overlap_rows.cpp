#include "kernels/overlap_rows.h"

#include <limits>

namespace vfplan {

SeenTotal seen_total(const SeenRow& row) {
    SeenTotal total;
    for (std::size_t i = 0; i < row.piece.size(); ++i) total.length_m += row.length_of(i);
    for (const float a : row.angle_rad) total.angle_rad += static_cast<double>(a);
    return total;
}

SeenJointly seen_jointly(const SeenRow& a, const SeenRow& b) {
    const bool angles_a = !a.angle_rad.empty();
    const bool angles_b = !b.angle_rad.empty();
    SeenJointly joint;
    for (std::size_t i = 0, k = 0; i < a.piece.size() && k < b.piece.size();) {
        if (a.piece[i] < b.piece[k]) {
            ++i;
        } else if (b.piece[k] < a.piece[i]) {
            ++k;
        } else {
            joint.length_m += a.length_of(i);
            if (angles_a) joint.angle_a_rad += static_cast<double>(a.angle_rad[i]);
            if (angles_b) joint.angle_b_rad += static_cast<double>(b.angle_rad[k]);
            ++i;
            ++k;
        }
    }
    return joint;
}

OverlapRow::OverlapRow(const CoverageRow& row, std::vector<double> length_m)
    : length_m_(std::move(length_m)) {
    piece_.reserve(row.size());
    angle_rad_.reserve(row.size());
    for (const Seen& s : row) {
        piece_.push_back(s.piece);
        angle_rad_.push_back(s.angle_rad);
    }
    total_ = seen_total(seen());
}

OverlapRow::OverlapRow(const CoverageRow& row, const Pieces& pieces)
    : OverlapRow(row, [&] {
          std::vector<double> length_m;
          length_m.reserve(row.size());
          for (const Seen& s : row) length_m.push_back(pieces.length_m(s.piece));
          return length_m;
      }()) {}

double overlap(OverlapRatio ratio, const OverlapRow& a, const OverlapRow& b) {
    return overlap(ratio, a.total(), b.total(), seen_jointly(a.seen(), b.seen()));
}

OverlapRows overlap_rows(const CoverageTable& table, bool angles) {
    OverlapRows out;
    out.begin = table.begin;
    out.piece.reserve(table.seen.size());
    for (const Seen& s : table.seen) out.piece.push_back(s.piece);
    if (!angles) return out;
    out.angle_rad.reserve(table.seen.size());
    for (const Seen& s : table.seen) out.angle_rad.push_back(s.angle_rad);
    return out;
}

std::vector<SeenTotal> seen_totals(const OverlapRows& rows,
                                   std::span<const double> piece_length_m) {
    std::vector<SeenTotal> out(idx(rows.size()));
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        out[idx(c)] = seen_total(rows.seen(c, piece_length_m));
    }
    return out;
}

LocalRows local_rows(const std::vector<OverlapRow>& rows) {
    std::int32_t first = std::numeric_limits<std::int32_t>::max();
    std::int32_t last = -1;
    for (const OverlapRow& row : rows) {
        if (row.empty()) continue;
        first = std::min(first, row.seen().piece.front());
        last = std::max(last, row.seen().piece.back());
    }
    LocalRows out;
    out.piece_length_m.assign(idx(std::max(0, last - first + 1)), 0);
    for (const OverlapRow& row : rows) {
        const SeenRow seen = row.seen();
        for (std::size_t i = 0; i < seen.piece.size(); ++i) {
            out.rows.piece.push_back(seen.piece[i] - first);
            out.piece_length_m[idx(seen.piece[i] - first)] = seen.length_of(i);
        }
        out.rows.angle_rad.insert(out.rows.angle_rad.end(), seen.angle_rad.begin(),
                                  seen.angle_rad.end());
        out.rows.begin.push_back(static_cast<std::int64_t>(out.rows.piece.size()));
    }
    return out;
}

PieceIndex index_of(const OverlapRows& rows, std::int64_t pieces) {
    return index_of(rows, pieces, 0, rows.size());
}

PieceIndex index_of(const OverlapRows& rows, std::int64_t pieces, std::int32_t from,
                    std::int32_t to) {
    // One place ahead, begin[p + 1] serves as piece p's write position: no second array.
    PieceIndex out;
    out.begin.assign(idx(pieces) + 2, 0);
    const auto first = idx(rows.begin[idx(from)]);
    const auto end = idx(rows.begin[idx(to)]);
    for (std::size_t i = first; i < end; ++i) ++out.begin[idx(rows.piece[i]) + 2];
    for (std::size_t p = 2; p < out.begin.size(); ++p) out.begin[p] += out.begin[p - 1];
    out.row.resize(end - first);
    for (std::int32_t r = from; r < to; ++r) {
        for (const std::int32_t p : rows.row(r)) out.row[idx(out.begin[idx(p) + 1]++)] = r;
    }
    out.begin.pop_back();
    return out;
}

void SharedLengths::grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    mask_ = slots_.size() - 1;
    --shift_;
    std::vector<std::uint32_t> used;
    used.swap(used_);
    for (const std::uint32_t i : used) add(old[i].row, old[i].length_m);
}

}  // namespace vfplan
