#include "kernels/overlap.h"

#include <gtest/gtest.h>

#include <random>

namespace vfplan {
namespace {

constexpr std::array<OverlapRatio, 5> all = {OverlapRatio::min_len, OverlapRatio::mean_len,
                                             OverlapRatio::union_len, OverlapRatio::union_ang,
                                             OverlapRatio::mean_ang};

// Pieces of the given lengths, each the left side of a wall of its own.
Pieces pieces_of(const std::vector<double>& lengths) {
    Pieces p;
    for (const double length : lengths) p.add_wall(length, 1, 0);
    return p;
}

// a sees pieces 0, 1, 2; b sees 1, 2, 3, 4. Fractions do not matter once C = 1.
const Pieces hand_made = pieces_of({4, 1, 2, 8, 5});
const CoverageRow row_a = {{0, 0.5F, 1.0F}, {1, 1, 0.25F}, {2, 0.75F, 0.5F}};
const CoverageRow row_b = {{1, 0.5F, 0.5F}, {2, 1, 1.0F}, {3, 1, 1.5F}, {4, 1, 0.25F}};

TEST(Overlap, FiveRatiosByHand) {
    // La = 7, Lb = 16, J = 3; ta = 1.75, tb = 3.25, ta_ab = 0.75, tb_ab = 1.5.
    const std::array<double, 5> want = {3 / 7.0, 6 / 23.0, 3 / 20.0, 2.25 / 5,
                                        0.75 / 3.5 + 1.5 / 6.5};
    for (std::size_t r = 0; r < all.size(); ++r) {
        EXPECT_NEAR(overlap(all[r], hand_made, row_a, row_b), want[r], 1e-12)
            << overlap_ratio_names[r];
    }
}

TEST(Overlap, NamesFollowTheOrderOfTheRatios) {
    EXPECT_EQ(overlap_ratio_names[static_cast<std::size_t>(OverlapRatio::mean_len)], "mean_len");
    EXPECT_EQ(overlap_ratio_names[static_cast<std::size_t>(OverlapRatio::mean_ang)], "mean_ang");
}

TEST(Overlap, NothingInCommonAndNothingAtAll) {
    for (const OverlapRatio r : all) {
        EXPECT_EQ(overlap(r, hand_made, {row_a[0]}, {row_b[2]}), 0);
        EXPECT_EQ(overlap(r, hand_made, {}, row_b), 0);
        EXPECT_EQ(overlap(r, hand_made, {}, {}), 0);
    }
}

TEST(Overlap, WithItselfIsOne) {
    for (const OverlapRatio r : all) EXPECT_DOUBLE_EQ(overlap(r, hand_made, row_b, row_b), 1);
}

struct RandomTable {
    Pieces pieces;
    CoverageTable table;
    std::vector<CoverageRow> rows;
    std::vector<SeenTotal> totals;
};

RandomTable random_table(std::uint64_t seed, std::int32_t rows, std::int32_t pieces) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> length(0.1, 5);
    std::uniform_real_distribution<float> angle(0.001F, 0.5F);
    RandomTable t;
    std::vector<double> lengths(static_cast<std::size_t>(pieces));
    for (double& l : lengths) l = length(random);
    t.pieces = pieces_of(lengths);
    for (std::int32_t r = 0; r < rows; ++r) {
        CoverageRow row;
        const auto from = static_cast<std::int32_t>(random() % static_cast<unsigned>(pieces));
        for (std::int32_t p = from; p < std::min(pieces, from + 25); ++p) {
            if (random() % 3 != 0) row.push_back({p, 1, angle(random)});
        }
        if (r % 17 == 5) row.clear();  // sees nothing
        t.table.add(row);
        t.totals.push_back(seen_total(t.pieces, row.data(), row.data() + row.size()));
        t.rows.push_back(std::move(row));
    }
    return t;
}

// All pairs of rows that overlap by the threshold.
std::vector<OverlapPair> pairs_of(const RandomTable& t, OverlapRatio ratio, double threshold) {
    std::vector<OverlapPair> out;
    for (std::size_t a = 0; a < t.rows.size(); ++a) {
        for (std::size_t b = a + 1; b < t.rows.size(); ++b) {
            const double o = overlap(ratio, t.pieces, t.rows[a], t.rows[b]);
            if (o <= 0 || o < threshold) continue;
            out.push_back({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), o});
        }
    }
    return out;
}

TEST(Overlap, LiesBetweenZeroAndOneAndIsSymmetric) {
    const RandomTable t = random_table(1, 60, 120);
    for (const OverlapRatio r : all) {
        for (const CoverageRow& a : t.rows) {
            for (const CoverageRow& b : t.rows) {
                const double o = overlap(r, t.pieces, a, b);
                EXPECT_GE(o, 0);
                EXPECT_LE(o, 1 + 1e-12);
                EXPECT_EQ(o, overlap(r, t.pieces, b, a));
            }
        }
    }
}

// Rows that bring their lengths along give the same bits.
TEST(Overlap, RowsWithLengthsGiveTheSame) {
    const RandomTable t = random_table(9, 60, 120);
    std::vector<OverlapRow> with_lengths;
    for (const CoverageRow& row : t.rows) {
        std::vector<SeenLength> seen;
        for (const Seen& s : row) {
            seen.push_back({s.piece, s.angle_rad, t.pieces.length_m(s.piece)});
        }
        with_lengths.push_back(overlap_row(std::move(seen)));
    }
    for (std::size_t i = 0; i < t.rows.size(); ++i) {
        EXPECT_EQ(with_lengths[i].total.length_m, t.totals[i].length_m);
        EXPECT_EQ(with_lengths[i].total.angle_rad, t.totals[i].angle_rad);
        for (std::size_t k = 0; k < t.rows.size(); ++k) {
            for (const OverlapRatio r : all) {
                EXPECT_EQ(overlap(r, with_lengths[i], with_lengths[k]),
                          overlap(r, t.pieces, t.rows[i], t.rows[k]));
            }
        }
    }
}

// mean_len = 2J / (La + Lb) >= 0.4 iff union_len = J / (La + Lb - J) >= 0.25.
TEST(Overlap, MeanAndUnionLengthGiveOneGraphAtConvertedThresholds) {
    for (std::uint64_t seed = 3; seed < 8; ++seed) {
        const RandomTable t = random_table(seed, 90, 150);
        const auto mean = pairs_of(t, OverlapRatio::mean_len, 0.4);
        const auto of_union = pairs_of(t, OverlapRatio::union_len, 0.25);
        ASSERT_EQ(mean.size(), of_union.size());
        EXPECT_GT(mean.size(), 20U);
        for (std::size_t i = 0; i < mean.size(); ++i) {
            EXPECT_EQ(mean[i].from, of_union[i].from);
            EXPECT_EQ(mean[i].to, of_union[i].to);
        }
    }
}

}  // namespace
}  // namespace vfplan
