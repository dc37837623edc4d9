// The five ratios, by hand and against sums made another way.
#include "kernels/overlap.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "kernels/overlap_rows.h"

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

double overlap_of(OverlapRatio ratio, const Pieces& pieces, const CoverageRow& a,
                  const CoverageRow& b) {
    return overlap(ratio, OverlapRow(a, pieces), OverlapRow(b, pieces));
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
        EXPECT_NEAR(overlap_of(all[r], hand_made, row_a, row_b), want[r], 1e-12)
            << formula(all[r]).name;
    }
}

TEST(Overlap, NamesFollowTheOrderOfTheRatios) {
    EXPECT_EQ(formula(OverlapRatio::mean_len).name, "mean_len");
    EXPECT_EQ(formula(OverlapRatio::mean_ang).name, "mean_ang");
    EXPECT_TRUE(formula(OverlapRatio::union_ang).by_angle);
    EXPECT_FALSE(formula(OverlapRatio::union_len).by_angle);
    ASSERT_EQ(all.size(), overlap_ratio_count);
}

TEST(Overlap, NothingInCommonAndNothingAtAll) {
    for (const OverlapRatio r : all) {
        EXPECT_EQ(overlap_of(r, hand_made, {row_a[0]}, {row_b[2]}), 0);
        EXPECT_EQ(overlap_of(r, hand_made, {}, row_b), 0);
        EXPECT_EQ(overlap_of(r, hand_made, {}, {}), 0);
    }
}

TEST(Overlap, WithItselfIsOne) {
    for (const OverlapRatio r : all) EXPECT_DOUBLE_EQ(overlap_of(r, hand_made, row_b, row_b), 1);
}

struct RandomTable {
    Pieces pieces;
    CoverageTable table;
    std::vector<CoverageRow> rows;
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
        t.rows.push_back(std::move(row));
    }
    return t;
}

struct Pair {
    std::size_t from;
    std::size_t to;
};

// All pairs of rows that overlap by the threshold.
std::vector<Pair> pairs_of(const RandomTable& t, OverlapRatio ratio, double threshold) {
    std::vector<Pair> out;
    for (std::size_t a = 0; a < t.rows.size(); ++a) {
        for (std::size_t b = a + 1; b < t.rows.size(); ++b) {
            const double o = overlap_of(ratio, t.pieces, t.rows[a], t.rows[b]);
            if (o <= 0 || o < threshold) continue;
            out.push_back({a, b});
        }
    }
    return out;
}

TEST(Overlap, LiesBetweenZeroAndOneAndIsSymmetric) {
    const RandomTable t = random_table(1, 60, 120);
    for (const OverlapRatio r : all) {
        for (const CoverageRow& a : t.rows) {
            for (const CoverageRow& b : t.rows) {
                const double o = overlap_of(r, t.pieces, a, b);
                EXPECT_GE(o, 0);
                EXPECT_LE(o, 1 + 1e-12);
                EXPECT_EQ(o, overlap_of(r, t.pieces, b, a));
            }
        }
    }
}

// Sums over a map of pieces, in place of the merge.
double by_map(OverlapRatio ratio, const Pieces& pieces, const CoverageRow& a,
              const CoverageRow& b) {
    std::map<std::int32_t, float> of_b;
    for (const Seen& s : b) of_b[s.piece] = s.angle_rad;
    double joint = 0;
    double angle_a = 0;
    double angle_b = 0;
    double length[2] = {0, 0};
    double angle[2] = {0, 0};
    for (const Seen& s : a) {
        length[0] += pieces.length_m(s.piece);
        angle[0] += s.angle_rad;
        const auto found = of_b.find(s.piece);
        if (found == of_b.end()) continue;
        joint += pieces.length_m(s.piece);
        angle_a += s.angle_rad;
        angle_b += found->second;
    }
    for (const Seen& s : b) {
        length[1] += pieces.length_m(s.piece);
        angle[1] += s.angle_rad;
    }
    if (joint == 0) return 0;
    switch (ratio) {
        case OverlapRatio::min_len:
            return joint / std::min(length[0], length[1]);
        case OverlapRatio::mean_len:
            return joint / (0.5 * (length[0] + length[1]));
        case OverlapRatio::union_len:
            return joint / (length[0] + length[1] - joint);
        case OverlapRatio::union_ang:
            return (angle_a + angle_b) / (angle[0] + angle[1]);
        default:
            return 0.5 * (angle_a / angle[0] + angle_b / angle[1]);
    }
}

TEST(Overlap, IsWhatSumsOverAMapGive) {
    const RandomTable t = random_table(9, 60, 120);
    for (const CoverageRow& a : t.rows) {
        for (const CoverageRow& b : t.rows) {
            for (const OverlapRatio r : all) {
                EXPECT_NEAR(overlap_of(r, t.pieces, a, b), by_map(r, t.pieces, a, b), 1e-12);
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

// Sums of lengths that are half of each other on paper.
TEST(OverlapRule, ATieIsEnough) {
    const OverlapRule rule{OverlapRatio::mean_len, 0.5};
    EXPECT_TRUE(rule.enough(0.5));
    EXPECT_TRUE(rule.enough(0.4999999999999999));
    EXPECT_FALSE(rule.enough(0.499999999));
    const OverlapRule none{OverlapRatio::mean_len, 0};
    EXPECT_FALSE(none.enough(0));
}

TEST(Overlap, ImpliedThresholdsHoldAndAreTheLargest) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> number(0, 1);
    const std::array by_length = {OverlapRatio::min_len, OverlapRatio::mean_len,
                                  OverlapRatio::union_len};
    std::map<std::pair<OverlapRatio, OverlapRatio>, double> least;  // beyond what is implied
    for (int i = 0; i < 200000; ++i) {
        const SeenTotal a{number(random) + 0.01, 0};
        const SeenTotal b{number(random) + 0.01, 0};
        const SeenJointly joint{number(random) * std::min(a.length_m, b.length_m), 0, 0};
        for (const OverlapRatio from : by_length) {
            for (const OverlapRatio to : by_length) {
                const double there = overlap(to, a, b, joint);
                const double implied = implied_threshold({from, overlap(from, a, b, joint)}, to);
                ASSERT_GE(there, implied - 1e-12);
                double& gap = least.try_emplace({from, to}, 1).first->second;
                if (implied > 0) gap = std::min(gap, there - implied);
            }
        }
    }
    for (const auto& [pair, gap] : least) {
        const bool none = pair.first == OverlapRatio::min_len && pair.second != pair.first;
        EXPECT_EQ(gap < 1e-3, !none) << formula(pair.first).name << formula(pair.second).name;
    }
    EXPECT_EQ(implied_threshold({OverlapRatio::mean_ang, 0.4}, OverlapRatio::mean_ang), 0.4);
    EXPECT_EQ(implied_threshold({OverlapRatio::mean_ang, 0.4}, OverlapRatio::min_len), 0);
    EXPECT_EQ(implied_threshold({OverlapRatio::mean_len, 0.4}, OverlapRatio::union_ang), 0);
    EXPECT_NEAR(implied_threshold({OverlapRatio::mean_len, 0.4}, OverlapRatio::union_len), 0.25,
                1e-12);
}

}  // namespace
}  // namespace vfplan
