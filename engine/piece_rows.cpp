#include "engine/piece_rows.h"

namespace vfplan {

PieceRows piece_rows(const CoverageTable& table, bool angles) {
    PieceRows out;
    out.begin = table.begin;
    out.piece.reserve(table.seen.size());
    for (const Seen& s : table.seen) out.piece.push_back(s.piece);
    if (!angles) return out;
    out.angle_rad.reserve(table.seen.size());
    for (const Seen& s : table.seen) out.angle_rad.push_back(s.angle_rad);
    return out;
}

AngleSource angles_of(const CoverageTable& table) {
    return [&table](std::int64_t from, std::int64_t count) {
        std::vector<float> out;
        out.reserve(at(count));
        for (std::int64_t i = from; i < from + count; ++i) {
            out.push_back(table.seen[at(i)].angle_rad);
        }
        return out;
    };
}

std::vector<double> piece_lengths_m(const Pieces& pieces) {
    std::vector<double> out;
    out.reserve(at(pieces.size()));
    for (std::int32_t wall = 0; wall < pieces.walls(); ++wall) {
        const double length = pieces.wall_length_m(wall);
        for (const Side side : {left, right}) {
            const std::int32_t n = pieces.count(wall, side);
            for (std::int32_t k = 0; k < n; ++k) {
                out.push_back(piece_begin_m(length, k + 1, n) - piece_begin_m(length, k, n));
            }
        }
    }
    return out;
}

PieceIndex index_of(const PieceRows& rows, std::int64_t pieces) {
    // One place ahead, begin[p + 1] serves as piece p's write position: no second array.
    PieceIndex out;
    out.begin.assign(at(pieces) + 2, 0);
    for (const std::int32_t p : rows.piece) ++out.begin[at(p) + 2];
    for (std::size_t p = 2; p < out.begin.size(); ++p) out.begin[p] += out.begin[p - 1];
    out.row.resize(rows.piece.size());
    for (std::int32_t r = 0; r < rows.size(); ++r) {
        for (const std::int32_t p : rows.row(r)) out.row[at(out.begin[at(p) + 1]++)] = r;
    }
    out.begin.pop_back();
    return out;
}

SeenTotal seen_total(const PieceRows& rows, const std::vector<double>& piece_length_m,
                     std::int32_t c) {
    SeenTotal total;
    for (const std::int32_t p : rows.row(c)) total.length_m += piece_length_m[at(p)];
    if (rows.angle_rad.empty()) return total;
    for (const float a : rows.angles(c)) total.angle_rad += static_cast<double>(a);
    return total;
}

std::vector<SeenTotal> seen_totals(const PieceRows& rows,
                                   const std::vector<double>& piece_length_m) {
    std::vector<SeenTotal> out(at(rows.size()));
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        out[at(c)] = seen_total(rows, piece_length_m, c);
    }
    return out;
}

SeenJointly seen_jointly(const PieceRows& rows, const std::vector<double>& piece_length_m,
                         std::int32_t a, std::int32_t b) {
    const std::span<const std::int32_t> of_a = rows.row(a);
    const std::span<const std::int32_t> of_b = rows.row(b);
    const bool angles = !rows.angle_rad.empty();
    SeenJointly joint;
    for (std::size_t i = 0, k = 0; i < of_a.size() && k < of_b.size();) {
        if (of_a[i] < of_b[k]) {
            ++i;
        } else if (of_b[k] < of_a[i]) {
            ++k;
        } else {
            joint.length_m += piece_length_m[at(of_a[i])];
            if (angles) {
                joint.angle_a_rad += static_cast<double>(rows.angles(a)[i]);
                joint.angle_b_rad += static_cast<double>(rows.angles(b)[k]);
            }
            ++i;
            ++k;
        }
    }
    return joint;
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
