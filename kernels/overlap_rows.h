// Rows of what stations cover, as far as overlap goes (equations 8 to 12): one view of a row, one
// way to merge two of them, one search for pairs. All sums go over pieces in ascending order, so
// that whoever asks for the overlap of two stations gets the same bits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernels/coverage.h"
#include "kernels/index.h"
#include "kernels/overlap.h"

namespace vfplan {

// A station's pieces, wherever they are kept. Refers to others' memory.
struct SeenRow {
    std::span<const std::int32_t> piece;    // ascending
    std::span<const float> angle_rad = {};  // of each entry; empty where nobody asks for angles
    std::span<const double> length_m = {};  // of each entry, or of each piece there is
    bool length_by_piece = false;

    double length_of(std::size_t entry) const {
        return length_m[length_by_piece ? idx(piece[entry]) : entry];
    }
};

// Angles are 0 where the row has none. Thread-safe.
SeenTotal seen_total(const SeenRow& row);
SeenJointly seen_jointly(const SeenRow& a, const SeenRow& b);

// One station's row with lengths of its own, for places where those of all pieces are not at hand.
class OverlapRow {
public:
    OverlapRow() = default;
    // `length_m` of each entry of the row.
    OverlapRow(const CoverageRow& row, std::vector<double> length_m);
    OverlapRow(const CoverageRow& row, const Pieces& pieces);

    SeenRow seen() const { return {piece_, angle_rad_, length_m_, false}; }
    const SeenTotal& total() const { return total_; }
    bool empty() const { return piece_.empty(); }

private:
    std::vector<std::int32_t> piece_;
    std::vector<float> angle_rad_;
    std::vector<double> length_m_;
    SeenTotal total_;
};
double overlap(OverlapRatio ratio, const OverlapRow& a, const OverlapRow& b);

// Row c = pieces that candidate c covers, ascending, as compressed sparse rows: four bytes an
// entry, eight with angles. Lengths are kept by piece, outside.
struct OverlapRows {
    std::vector<std::int64_t> begin = {0};  // size() + 1 offsets into `piece`
    std::vector<std::int32_t> piece;
    std::vector<float> angle_rad;  // by entry, where overlap goes by angle; else empty

    std::int32_t size() const { return static_cast<std::int32_t>(begin.size()) - 1; }
    std::int64_t entries() const { return begin.back(); }
    std::span<const std::int32_t> row(std::int32_t c) const { return part(piece, c); }
    SeenRow seen(std::int32_t c, std::span<const double> piece_length_m) const {
        return {row(c), angle_rad.empty() ? std::span<const float>() : part(angle_rad, c),
                piece_length_m, true};
    }

private:
    template <class T>
    std::span<const T> part(const std::vector<T>& of, std::int32_t c) const {
        return {of.data() + begin[idx(c)], of.data() + begin[idx(c) + 1]};
    }
};
OverlapRows overlap_rows(const CoverageTable& table, bool angles);
std::vector<SeenTotal> seen_totals(const OverlapRows& rows, std::span<const double> piece_length_m);

// Rows of a few stations that lie together, with pieces numbered anew from 0 in the same order.
struct LocalRows {
    OverlapRows rows;
    std::vector<double> piece_length_m;
};
LocalRows local_rows(const std::vector<OverlapRow>& rows);

// For each piece the rows that cover it, ascending. As large as the rows: freed when done with.
struct PieceIndex {
    std::vector<std::int64_t> begin;
    std::vector<std::int32_t> row;

    std::int64_t pieces() const { return static_cast<std::int64_t>(begin.size()) - 1; }
    std::span<const std::int32_t> rows_of(std::int32_t p) const {
        return {row.data() + begin[idx(p)], row.data() + begin[idx(p) + 1]};
    }
};
PieceIndex index_of(const OverlapRows& rows, std::int64_t pieces);
// Of the rows from..to alone, by their numbers.
PieceIndex index_of(const OverlapRows& rows, std::int64_t pieces, std::int32_t from,
                    std::int32_t to);

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

// The search for pairs of rows that share a piece. Its time is the number of pieces that rows
// share, not that of pairs of rows. Refers to what it is made of; one thread at a time.
class PairSearch {
public:
    // With `angles`, which the rows then have, the joint sums hold them too.
    PairSearch(const OverlapRows& rows, const PieceIndex& index,
               std::span<const double> piece_length_m, bool angles)
        : rows_(rows), index_(index), piece_length_m_(piece_length_m), angles_(angles) {}

    // Calls f(n, joint) for each row n > r that shares a piece with row r and is wanted(n); in no
    // order that means anything.
    template <class Wanted, class F>
    void after(std::int32_t r, Wanted&& wanted, F&& f) {
        for (const std::int32_t p : rows_.row(r)) {
            const std::span<const std::int32_t> viewers = index_.rows_of(p);
            for (auto n = std::upper_bound(viewers.begin(), viewers.end(), r); n != viewers.end();
                 ++n) {
                if (wanted(*n)) shared_.add(*n, piece_length_m_[idx(p)]);
            }
        }
        shared_.take([&](std::int32_t n, double length_m) {
            // The angle from the other side is not in the index.
            f(n, angles_
                     ? seen_jointly(rows_.seen(r, piece_length_m_), rows_.seen(n, piece_length_m_))
                     : SeenJointly{length_m, 0, 0});
        });
    }

private:
    const OverlapRows& rows_;
    const PieceIndex& index_;
    std::span<const double> piece_length_m_;
    bool angles_;
    SharedLengths shared_;
};

}  // namespace vfplan
