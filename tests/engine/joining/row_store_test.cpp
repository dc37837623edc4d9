#include "engine/joining/row_store.h"

#include <gtest/gtest.h>

#include <random>

namespace vfplan {
namespace {

// Ascending pieces, some of them in runs; empty rows among them.
OverlapRows random_rows(std::uint64_t seed, bool angles) {
    std::mt19937_64 random(seed);
    OverlapRows out;
    const int rows = static_cast<int>(random() % 12);
    for (int r = 0; r < rows; ++r) {
        std::int32_t piece = 0;
        const int entries = static_cast<int>(random() % 20);
        for (int i = 0; i < entries; ++i) {
            piece += random() % 3 == 0 ? 1 + static_cast<std::int32_t>(random() % 9) : 1;
            out.piece.push_back(piece);
            if (angles) out.angle_rad.push_back(static_cast<float>(random() % 1000));
        }
        out.begin.push_back(static_cast<std::int64_t>(out.piece.size()));
    }
    return out;
}

std::vector<std::int32_t> pieces(const OverlapRows& rows, std::int32_t r) {
    return {rows.row(r).begin(), rows.row(r).end()};
}
std::vector<float> angles(const OverlapRows& rows, std::int32_t r) {
    const auto seen = rows.seen(r, {}).angle_rad;
    return {seen.begin(), seen.end()};
}

PackedRows packed_of(const OverlapRows& rows, std::int32_t from, std::int32_t first_piece) {
    PackedRows out;
    for (std::int32_t r = from; r < rows.size(); ++r) {
        out.add(rows.row(r), rows.seen(r, {}).angle_rad, first_piece);
    }
    return out;
}

TEST(RowStore, PackedRowsComeOutAsTheyWentIn) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const bool with_angles = seed % 2 == 0;
        const OverlapRows rows = random_rows(seed, with_angles);
        const std::int32_t from = rows.size() / 3;
        const PackedRows first = packed_of(rows, from, 100);
        PackedRows packed;  // by way of others
        for (std::size_t r = 0; r < first.size(); ++r) packed.add(first, r);
        ASSERT_EQ(packed.entries(), rows.begin.back() - rows.begin[idx(from)]);
        OverlapRows out;
        for (std::int32_t r = rows.size(); r-- > from;) packed.unpack(idx(r - from), out);
        ASSERT_EQ(out.size(), rows.size() - from) << "seed " << seed;
        for (std::int32_t i = 0; i < out.size(); ++i) {
            const std::int32_t r = rows.size() - 1 - i;
            std::vector<std::int32_t> want = pieces(rows, r);
            for (std::int32_t& p : want) p += 100;
            ASSERT_EQ(pieces(out, i), want) << "seed " << seed;
            ASSERT_EQ(angles(out, i), angles(rows, r)) << "seed " << seed;
        }
    }
}

TEST(RowStore, WhatIsKeptStaysInOrder) {
    std::mt19937_64 random(5);
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const OverlapRows rows = random_rows(seed, seed % 2 == 0);
        std::vector<bool> kept;
        for (std::int32_t r = 0; r < rows.size(); ++r) kept.push_back(random() % 2 == 0);
        PackedRows packed = packed_of(rows, 0, 0);
        packed.keep(kept);
        std::size_t next = 0;
        std::int64_t entries = 0;
        for (std::int32_t r = 0; r < rows.size(); ++r) {
            if (!kept[idx(r)]) continue;
            ASSERT_LT(next, packed.size());
            OverlapRows out;
            packed.unpack(next++, out);
            ASSERT_EQ(pieces(out, 0), pieces(rows, r)) << "seed " << seed;
            ASSERT_EQ(angles(out, 0), angles(rows, r)) << "seed " << seed;
            entries += out.entries();
        }
        ASSERT_EQ(next, packed.size());
        ASSERT_EQ(entries, packed.entries());
    }
}

}  // namespace
}  // namespace vfplan
