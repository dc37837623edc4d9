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

TEST(RowStore, PackedRowsComeOutAsTheyWentIn) {
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const bool with_angles = seed % 2 == 0;
        const OverlapRows rows = random_rows(seed, with_angles);
        const std::int32_t from = rows.size() / 3;
        const PackedRows packed(rows, from, 100);
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

TEST(RowStore, AppendedRowsStandBehind) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const bool with_angles = seed % 2 == 0;
        const OverlapRows front = random_rows(seed, with_angles);
        const OverlapRows back = random_rows(seed + 1000, with_angles);
        OverlapRows out = front;
        append(back, out);
        ASSERT_EQ(out.size(), front.size() + back.size());
        for (std::int32_t r = 0; r < out.size(); ++r) {
            const OverlapRows& from = r < front.size() ? front : back;
            const std::int32_t there = r < front.size() ? r : r - front.size();
            ASSERT_EQ(pieces(out, r), pieces(from, there)) << "seed " << seed;
            ASSERT_EQ(angles(out, r), angles(from, there)) << "seed " << seed;
        }
    }
}

TEST(RowStore, WhatIsKeptStaysInOrder) {
    std::mt19937_64 random(5);
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const OverlapRows rows = random_rows(seed, false);
        std::vector<bool> kept;
        for (std::int32_t r = 0; r < rows.size(); ++r) kept.push_back(random() % 2 == 0);
        OverlapRows out = rows;
        keep(kept, out);
        std::int32_t next = 0;
        for (std::int32_t r = 0; r < rows.size(); ++r) {
            if (!kept[idx(r)]) continue;
            ASSERT_LT(next, out.size());
            ASSERT_EQ(pieces(out, next++), pieces(rows, r)) << "seed " << seed;
        }
        ASSERT_EQ(next, out.size());
    }
}

}  // namespace
}  // namespace vfplan
