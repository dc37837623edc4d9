// At which overlap networks would join.
#include "engine/plan/join_thresholds.h"

#include <gtest/gtest.h>

#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

using test::hand_made;
using test::HandMade;

// Stations: candidates with their networks.
Plan plan_of(const std::vector<std::pair<std::int32_t, std::int32_t>>& stations) {
    Plan plan;
    for (const auto& [candidate, network] : stations) {
        Station s;
        s.candidate = candidate;
        s.network = network;
        plan.stations.push_back(s);
    }
    return plan;
}

JoinThresholds thresholds_of(const HandMade& h, const Plan& plan, double threshold = 0.3,
                             OverlapRatio ratio = OverlapRatio::mean_len, int threads = 1) {
    return find_join_thresholds(Threads(threads), h.input(), {ratio, threshold}, {}, plan);
}

const std::vector<double> ones(20, 1.0);

TEST(Joining, OneNetworkOrNone) {
    const HandMade h = hand_made(ones, {{0, 1}, {1, 2}}, {});
    EXPECT_EQ(thresholds_of(h, plan_of({})).joins_at, std::vector<double>{});
    const JoinThresholds one = thresholds_of(h, plan_of({{0, 0}, {1, 0}}));
    EXPECT_EQ(one.joins_at, std::vector<double>{1});
    EXPECT_EQ(one.networks_by_min_len, 1);
}

TEST(Joining, DirectOverlap) {
    // 2 J / (La + Lb) = 2 / 10.
    const HandMade h = hand_made(ones, {{0, 1, 2, 3}, {3, 4, 5, 6, 7, 8}}, {});
    const JoinThresholds j = thresholds_of(h, plan_of({{0, 0}, {1, 1}}));
    ASSERT_EQ(j.joins_at.size(), 2U);
    EXPECT_EQ(j.joins_at[0], 1);
    EXPECT_DOUBLE_EQ(j.joins_at[1], 0.2);
    // 1 / 9 by the union.
    EXPECT_DOUBLE_EQ(
        thresholds_of(h, plan_of({{0, 0}, {1, 1}}), 0.3, OverlapRatio::union_len).joins_at[1],
        1.0 / 9);
}

TEST(Joining, TheWeakestLinkOfTheBestChainOverAllCandidates) {
    // 0 and 2 share a piece (2 / 8). Over 1, no station: 4 / 6 and 4 / 8.
    const HandMade h = hand_made(ones, {{0, 1, 2}, {1, 2, 3}, {2, 3, 4, 5, 6}}, {});
    EXPECT_DOUBLE_EQ(thresholds_of(h, plan_of({{0, 0}, {2, 1}})).joins_at[1], 0.5);
    const HandMade without = hand_made(ones, {{0, 1, 2}, {2, 3, 4, 5, 6}}, {});
    EXPECT_DOUBLE_EQ(thresholds_of(without, plan_of({{0, 0}, {1, 1}})).joins_at[1], 0.25);
}

TEST(Joining, EachNetworkItsOwnAndZeroForWhatSharesNothing) {
    const HandMade h = hand_made(
        ones, {{0, 1, 2, 3}, {3, 4, 5, 6}, {10, 11}, {11, 12, 13, 14, 15, 16}, {6, 7, 8, 9}}, {});
    // Networks: 0 main, 1: candidate 4 (over candidate 1), 2 and 3: joined to each other only.
    const JoinThresholds j = thresholds_of(h, plan_of({{0, 0}, {4, 1}, {2, 2}, {3, 3}}));
    EXPECT_EQ(j.joins_at, (std::vector<double>{1, 0.25, 0, 0}));
    EXPECT_EQ(j.joins_at, thresholds_of(h, plan_of({{0, 0}, {4, 1}, {2, 2}, {3, 3}}), 0.3,
                                        OverlapRatio::mean_len, 2)
                              .joins_at);
}

TEST(Joining, NetworksByTheRatioToTheSmaller) {
    // Small 0 lies within large 1: mean_len 4 / 12, min_len 1; 2 shares a quarter of itself.
    const HandMade h =
        hand_made(ones, {{0, 1}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}, {9, 10, 11, 12}}, {});
    const Plan plan = plan_of({{1, 0}, {0, 1}, {2, 2}});
    EXPECT_EQ(thresholds_of(h, plan, 0.4).networks_by_min_len, 2);
    EXPECT_EQ(thresholds_of(h, plan, 0.25).networks_by_min_len, 1);
    EXPECT_EQ(thresholds_of(h, plan, 0.26).networks_by_min_len, 2);
    // Candidates that are no stations join too.
    EXPECT_EQ(thresholds_of(h, plan_of({{0, 0}, {2, 1}}), 0.25).networks_by_min_len, 1);
}

}  // namespace
}  // namespace vfplan
