// What planning needs of the coverage table: who covers which piece, at four bytes an entry.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "kernels/coverage.h"
#include "kernels/index.h"
#include "kernels/overlap.h"

namespace vfplan {

// Row c = pieces that candidate c covers, ascending, as compressed sparse rows.
struct PieceRows {
    std::vector<std::int64_t> begin = {0};  // size() + 1 offsets into `piece`
    std::vector<std::int32_t> piece;
    std::vector<float> angle_rad;  // by entry, where overlap goes by angle; else empty

    std::int32_t size() const { return static_cast<std::int32_t>(begin.size()) - 1; }
    std::int64_t entries() const { return begin.back(); }
    std::span<const std::int32_t> row(std::int32_t c) const { return part(piece, c); }
    std::span<const float> angles(std::int32_t c) const { return part(angle_rad, c); }

private:
    template <class T>
    std::span<const T> part(const std::vector<T>& of, std::int32_t c) const {
        return {of.data() + begin[at(c)], of.data() + begin[at(c) + 1]};
    }
};

// The angles of `count` entries from `from` on, wherever they are kept. Ranges are asked for in
// ascending order, no entry twice.
using AngleSource = std::function<std::vector<float>(std::int64_t from, std::int64_t count)>;

PieceRows piece_rows(const CoverageTable& table, bool angles);
AngleSource angles_of(const CoverageTable& table);  // refers to it
std::vector<double> piece_lengths_m(const Pieces& pieces);

// For each piece the rows that cover it, ascending. As large as the rows: freed when done with.
struct PieceIndex {
    std::vector<std::int64_t> begin;
    std::vector<std::int32_t> row;

    std::int64_t pieces() const { return static_cast<std::int64_t>(begin.size()) - 1; }
    std::span<const std::int32_t> rows_of(std::int32_t p) const {
        return {row.data() + begin[at(p)], row.data() + begin[at(p) + 1]};
    }
};
PieceIndex index_of(const PieceRows& rows, std::int64_t pieces);

inline bool by_angle(OverlapRatio ratio) {
    return ratio == OverlapRatio::union_ang || ratio == OverlapRatio::mean_ang;
}

// As of kernels/overlap.h: sums over pieces in their order. Without angles these are 0.
SeenTotal seen_total(const PieceRows& rows, const std::vector<double>& piece_length_m,
                     std::int32_t c);
std::vector<SeenTotal> seen_totals(const PieceRows& rows,
                                   const std::vector<double>& piece_length_m);
SeenJointly seen_jointly(const PieceRows& rows, const std::vector<double>& piece_length_m,
                         std::int32_t a, std::int32_t b);

// Length by row, for the few rows that one row shares pieces with: as large as they are, not as
// all rows. Reused from row to row; not thread-safe.
class SharedLengths {
public:
    void add(std::int32_t row, double length_m) {
        std::size_t i = slot(row);
        while (slots_[i].row != row) {
            if (slots_[i].row < 0) {
                slots_[i].row = row;
                used_.push_back(static_cast<std::uint32_t>(i));
                break;
            }
            i = (i + 1) & mask_;
        }
        slots_[i].length_m += length_m;
        if (2 * used_.size() > mask_) grow();
    }
    // Calls f(row, length_m) in no order that means anything and forgets everything.
    template <class F>
    void take(F&& f) {
        for (const std::uint32_t i : used_) {
            f(slots_[i].row, slots_[i].length_m);
            slots_[i] = {};
        }
        used_.clear();
    }

private:
    struct Slot {
        std::int32_t row = -1;
        double length_m = 0;
    };
    std::size_t slot(std::int32_t row) const {
        return (static_cast<std::uint32_t>(row) * 2654435769U >> shift_) & mask_;
    }
    void grow();

    static constexpr unsigned first_bits = 9;
    std::vector<Slot> slots_ = std::vector<Slot>(std::size_t{1} << first_bits);
    std::size_t mask_ = (std::size_t{1} << first_bits) - 1;
    unsigned shift_ = 32 - first_bits;
    std::vector<std::uint32_t> used_;
};

}  // namespace vfplan
