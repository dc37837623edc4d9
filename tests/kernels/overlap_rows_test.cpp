// Rows of pieces: three ways to keep them, one overlap; the inverted index and the search for
// pairs.
#include "kernels/overlap_rows.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "tests/kernels/random_table.h"

namespace vfplan {
namespace {

using test::random_table;

TEST(OverlapRows, HoldTheTable) {
    const CoverageTable table = random_table(1, 40, 30);
    const OverlapRows rows = overlap_rows(table, true);
    ASSERT_EQ(rows.size(), 40);
    for (std::int32_t r = 0; r < rows.size(); ++r) {
        const CoverageRow row = test::row_of(table, r);
        const SeenRow seen = rows.seen(r, {});
        ASSERT_EQ(seen.piece.size(), row.size());
        for (std::size_t i = 0; i < row.size(); ++i) {
            EXPECT_EQ(seen.piece[i], row[i].piece);
            EXPECT_EQ(seen.angle_rad[i], row[i].angle_rad);
        }
    }
    EXPECT_TRUE(overlap_rows(table, false).angle_rad.empty());
}

std::vector<double> random_lengths(std::uint64_t seed, std::int32_t pieces) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> length(0.1, 5);
    std::vector<double> out(idx(pieces));
    for (double& l : out) l = length(random);
    return out;
}

// Whatever keeps the rows, and whoever asks: the same bits.
TEST(OverlapRows, EveryWayToTheOverlapOfTwoRowsGivesTheSameBits) {
    for (std::uint64_t seed = 10; seed < 20; ++seed) {
        constexpr std::int32_t pieces = 90;
        const CoverageTable table = random_table(seed, 40, pieces);
        const std::vector<double> lengths = random_lengths(seed, pieces);
        const OverlapRows rows = overlap_rows(table, true);
        std::vector<OverlapRow> own;  // numbered from 1000 on
        for (std::int64_t r = 0; r < table.rows(); ++r) {
            CoverageRow row = test::row_of(table, r);
            std::vector<double> of_entries;
            for (Seen& s : row) {
                of_entries.push_back(lengths[idx(s.piece)]);
                s.piece += 1000;
            }
            own.emplace_back(row, of_entries);
        }
        const LocalRows local = local_rows(own);
        const std::vector<SeenTotal> totals = seen_totals(rows, lengths);
        const PieceIndex index = index_of(rows, pieces);
        const PieceIndex local_index =
            index_of(local.rows, static_cast<std::int64_t>(local.piece_length_m.size()));
        for (const OverlapFormula& f : overlap_ratios) {
            PairSearch search(rows, index, lengths, f.by_angle);
            PairSearch local_search(local.rows, local_index, local.piece_length_m, f.by_angle);
            for (std::int32_t r = 0; r < rows.size(); ++r) {
                std::map<std::int32_t, double> want;
                for (std::int32_t n = r + 1; n < rows.size(); ++n) {
                    if (n % 7 == 3) continue;  // not wanted
                    const double o = overlap(f.ratio, own[idx(r)], own[idx(n)]);
                    if (o > 0) want[n] = o;
                }
                for (PairSearch* each : {&search, &local_search}) {
                    std::map<std::int32_t, double> got;
                    each->after(
                        r, [](std::int32_t n) { return n % 7 != 3; },
                        [&](std::int32_t n, const SeenJointly& joint) {
                            got[n] = overlap(f.ratio, totals[idx(r)], totals[idx(n)], joint);
                        });
                    EXPECT_EQ(got, want) << f.name << " of row " << r << ", seed " << seed;
                }
            }
        }
    }
}

TEST(OverlapRows, AnglesOfOneEndAreEnoughForItsSums) {
    const CoverageTable table = random_table(21, 10, 40);
    const std::vector<double> lengths = random_lengths(21, 40);
    const OverlapRows with = overlap_rows(table, true);
    const OverlapRows without = overlap_rows(table, false);
    const SeenJointly both = seen_jointly(with.seen(0, lengths), with.seen(1, lengths));
    const SeenJointly first = seen_jointly(with.seen(0, lengths), without.seen(1, lengths));
    const SeenJointly second = seen_jointly(without.seen(0, lengths), with.seen(1, lengths));
    EXPECT_GT(both.length_m, 0);
    EXPECT_EQ(first.length_m, both.length_m);
    EXPECT_EQ(first.angle_a_rad, both.angle_a_rad);
    EXPECT_EQ(first.angle_b_rad, 0);
    EXPECT_EQ(second.angle_b_rad, both.angle_b_rad);
    EXPECT_EQ(second.angle_a_rad, 0);
}

TEST(OverlapRows, NoRowsAndEmptyOnesMakeNoPieces) {
    EXPECT_TRUE(local_rows({}).piece_length_m.empty());
    const LocalRows empty = local_rows({OverlapRow(), OverlapRow()});
    EXPECT_EQ(empty.rows.size(), 2);
    EXPECT_TRUE(empty.piece_length_m.empty());
}

TEST(OverlapRows, IndexListsTheRowsOfEachPiece) {
    const OverlapRows rows = overlap_rows(random_table(3, 40, 30), false);
    const PieceIndex index = index_of(rows, 33);
    ASSERT_EQ(index.pieces(), 33);
    for (std::int32_t p = 0; p < 33; ++p) {
        std::vector<std::int32_t> want;
        for (std::int32_t r = 0; r < rows.size(); ++r) {
            const auto row = rows.row(r);
            if (std::find(row.begin(), row.end(), p) != row.end()) want.push_back(r);
        }
        const auto got = index.rows_of(p);
        EXPECT_EQ(std::vector<std::int32_t>(got.begin(), got.end()), want);
    }
    EXPECT_EQ(index_of(OverlapRows(), 0).pieces(), 0);
}

TEST(SharedLengths, AddUpByRowHoweverMany) {
    std::mt19937_64 random(4);
    SharedLengths shared;
    for (const std::uint64_t rows : {3U, 5000U, 40U}) {  // grows, and forgets
        std::map<std::int32_t, double> want;
        for (int i = 0; i < 20000; ++i) {
            const auto row = static_cast<std::int32_t>(random() % rows * 1048576 % 2000000011);
            const double length = 0.1 * static_cast<double>(random() % 50);
            want[row] += length;
            shared.add(row, length);
        }
        std::map<std::int32_t, double> got;
        shared.take(
            [&](std::int32_t row, double length) { EXPECT_TRUE(got.emplace(row, length).second); });
        EXPECT_EQ(got, want);
    }
}

}  // namespace
}  // namespace vfplan
