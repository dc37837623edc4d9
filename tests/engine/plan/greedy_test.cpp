// Algorithm 1, rule by rule.
#include <gtest/gtest.h>

#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

using test::hand_made;
using test::HandMade;

Chosen greedy(const HandMade& h, const std::vector<std::int32_t>& forced = {}) {
    auto wanted = h.wanted();
    return test::greedy_alone(h, h.everyone(), forced, wanted);
}

TEST(Greedy, SeedCoversTheMostLengthNotTheMostPieces) {
    const HandMade h = hand_made({1, 1, 1, 5}, {{0, 1, 2}, {3}}, {{0, 1, 0.5}});
    EXPECT_EQ(greedy(h), (Chosen{1, 0}));
}

TEST(Greedy, SeedTiesGoToVfThenXThenY) {
    HandMade h = hand_made({1, 1, 1, 1}, {{0}, {1}, {2}, {3}},
                           {{0, 1, 0.5}, {0, 2, 0.5}, {0, 3, 0.5}, {1, 2, 0.5}, {2, 3, 0.5}});
    EXPECT_EQ(greedy(h).front(), 0);
    for (Candidate& c : h.candidates) c.at = {5, 5};
    h.candidates[2].at = {5, 4};
    EXPECT_EQ(greedy(h).front(), 2);  // y
    h.candidates[3].at = {4, 9};
    EXPECT_EQ(greedy(h).front(), 3);  // x before y
    h.candidates[1].vf_rad = 0.5F;
    EXPECT_EQ(greedy(h).front(), 1);  // VF before x
    h.length_m[0] = 1.5;
    EXPECT_EQ(greedy(h).front(), 0);  // length before VF
}

TEST(Greedy, SeedCountsOnlyWhatIsStillWanted) {
    const HandMade h = hand_made({9, 2, 1}, {{0, 2}, {1}}, {{0, 1, 0.5}});
    std::vector<std::uint8_t> wanted = {0, 1, 1};
    EXPECT_EQ(test::greedy_alone(h, {0, 1}, {}, wanted), (Chosen{1, 0}));
    EXPECT_EQ(wanted, (std::vector<std::uint8_t>{0, 0, 0}));
}

TEST(Greedy, FrontierTakesTheMostNewCoverage) {
    // 1 sees most in all, but what it sees beyond the seed is least; overlap does not matter.
    const HandMade h = hand_made({10, 9, 1, 2, 3}, {{0, 1}, {1, 2}, {3}, {4}},
                                 {{0, 1, 0.9}, {0, 2, 0.8}, {0, 3, 0.1}});
    EXPECT_EQ(greedy(h), (Chosen{0, 3, 2, 1}));
}

TEST(Greedy, FrontierTiesGoToTheHighestOverlapThenTheId) {
    const std::vector<std::vector<std::int32_t>> rows = {{0}, {1}, {2}, {3}};
    const HandMade by_overlap =
        hand_made({10, 1, 1, 1}, rows, {{0, 1, 0.5}, {0, 2, 0.7}, {0, 3, 0.6}});
    EXPECT_EQ(greedy(by_overlap), (Chosen{0, 2, 3, 1}));
    const HandMade by_id = hand_made({10, 1, 1, 1}, rows, {{0, 1, 0.5}, {0, 2, 0.5}, {0, 3, 0.5}});
    EXPECT_EQ(greedy(by_id), (Chosen{0, 1, 2, 3}));
}

TEST(Greedy, OverlapIsTheHighestWithAnyChosenOne) {
    // 2 beats 3 by overlap with the seed, until 1 is chosen, which 3 overlaps more.
    const HandMade h = hand_made({10, 5, 1, 1}, {{0}, {1}, {2}, {3}},
                                 {{0, 1, 0.4}, {0, 2, 0.6}, {0, 3, 0.5}, {1, 3, 0.9}});
    EXPECT_EQ(greedy(h), (Chosen{0, 1, 3, 2}));
    // A later, lower overlap does not take anything away.
    const HandMade g = hand_made({10, 5, 1, 1}, {{0}, {1}, {2}, {3}},
                                 {{0, 1, 0.4}, {0, 2, 0.6}, {0, 3, 0.7}, {1, 3, 0.5}});
    EXPECT_EQ(greedy(g), (Chosen{0, 1, 3, 2}));
}

TEST(Greedy, GainsShrinkAsOthersAreChosen) {
    // 1 promises 7 m, but 2 (8 m) takes 6 of them; then 3 (4 m) is better.
    const HandMade h = hand_made({20, 6, 2, 1, 4}, {{0}, {1, 3}, {1, 2}, {4}},
                                 {{0, 1, 0.9}, {0, 2, 0.5}, {0, 3, 0.5}});
    EXPECT_EQ(greedy(h), (Chosen{0, 2, 3, 1}));
}

TEST(Greedy, NothingIsTakenThatAddsNothing) {
    const HandMade h = hand_made({5, 3}, {{0, 1}, {0}, {1}}, {{0, 1, 0.9}, {1, 2, 0.9}});
    EXPECT_EQ(greedy(h), (Chosen{0}));
}

TEST(Greedy, OnlyTheFrontierIsLookedAt) {
    // 3 adds 9 m but lies behind 2, which adds 1 m; 1 adds 2 m.
    const HandMade h =
        hand_made({10, 2, 1, 9}, {{0}, {1}, {2}, {3}}, {{0, 1, 0.5}, {0, 2, 0.5}, {2, 3, 0.5}});
    EXPECT_EQ(greedy(h), (Chosen{0, 1, 2, 3}));
}

TEST(Greedy, ShortestPathWhereNoFrontierStationAdds) {
    // 0 - 1 - 2 - 3 is shorter than 0 - 4 - 5 - 6 - 3.
    const HandMade h = hand_made({10, 4}, {{0}, {0}, {0}, {1}, {0}, {0}, {0}},
                                 {{0, 1, 0.4},
                                  {1, 2, 0.4},
                                  {2, 3, 0.4},
                                  {0, 4, 0.9},
                                  {4, 5, 0.9},
                                  {5, 6, 0.9},
                                  {3, 6, 0.9}});
    EXPECT_EQ(greedy(h), (Chosen{0, 1, 2, 3}));
}

TEST(Greedy, FewerHopsBeforeMoreGain) {
    const HandMade h = hand_made({10, 1, 8}, {{0}, {}, {1}, {}, {}, {2}},
                                 {{0, 1, 0.5}, {1, 2, 0.5}, {0, 3, 0.5}, {3, 4, 0.5}, {4, 5, 0.5}});
    EXPECT_EQ(greedy(h), (Chosen{0, 1, 2, 3, 4, 5}));
}

TEST(Greedy, EquallyFarGoalsGoByGainAndPathsByOverlap) {
    const HandMade h = hand_made({10, 1, 8}, {{0}, {}, {}, {1}, {2}},
                                 {{0, 1, 0.9}, {0, 2, 0.5}, {1, 3, 0.9}, {1, 4, 0.4}, {2, 4, 0.6}});
    EXPECT_EQ(greedy(h), (Chosen{0, 2, 4, 1, 3}));
}

TEST(Greedy, ForcedOnesComeFirstAndAreJoined) {
    const HandMade h = hand_made({10, 1, 1}, {{0}, {1}, {}, {2}, {}},
                                 {{0, 1, 0.9}, {1, 2, 0.9}, {2, 3, 0.9}, {3, 4, 0.9}});
    EXPECT_EQ(greedy(h, {4, 1}), (Chosen{4, 3, 2, 1, 0}));
}

// Candidate 0 sees piece 0; a chain from it, of `hops` steps, ends where piece `piece` is seen.
// Returns the chain's candidates.
Chosen add_chain(std::vector<std::vector<std::int32_t>>& rows, std::vector<OverlapPair>& edges,
                 int hops, std::int32_t piece, double overlap, std::int32_t from = 0) {
    Chosen chain;
    for (int k = 0; k < hops; ++k) {
        const auto next = static_cast<std::int32_t>(rows.size());
        edges.push_back({from, next, overlap});
        rows.emplace_back();
        chain.push_back(next);
        from = next;
    }
    rows.back() = {piece};
    return chain;
}

TEST(Greedy, FarGainsAreFoundInOrderOfHops) {
    std::vector<std::vector<std::int32_t>> rows = {{0}};
    std::vector<OverlapPair> edges;
    const Chosen farthest = add_chain(rows, edges, 30, 1, 0.9);
    const Chosen near = add_chain(rows, edges, 9, 2, 0.4);
    const Chosen middle = add_chain(rows, edges, 17, 3, 0.5);
    // Beyond the end of `near`, 10 hops more: after it nearer than `middle`.
    const Chosen after = add_chain(rows, edges, 10, 4, 0.3, near.back());
    const HandMade h = hand_made({50, 20, 1, 9, 2}, rows, edges);
    Chosen want = {0};
    for (const Chosen* c : {&near, &after, &middle, &farthest}) {
        want.insert(want.end(), c->begin(), c->end());
    }
    EXPECT_EQ(greedy(h), want);
}

TEST(Greedy, FarGoalsGoByGainAndPathsByOverlapToo) {
    std::vector<std::vector<std::int32_t>> rows = {{0}};
    std::vector<OverlapPair> edges;
    const Chosen less = add_chain(rows, edges, 12, 1, 0.9);
    const Chosen weak = add_chain(rows, edges, 12, 2, 0.5);
    // Another path of 12 hops to the end of `weak`, with a better last step.
    Chosen strong = add_chain(rows, edges, 11, 0, 0.4);
    rows[static_cast<std::size_t>(strong.back())] = {};
    edges.push_back({weak.back(), strong.back(), 0.6});
    strong.push_back(weak.back());
    const HandMade h = hand_made({50, 1, 9}, rows, edges);
    Chosen want = {0};
    want.insert(want.end(), strong.begin(), strong.end());
    want.insert(want.end(), less.begin(), less.end());
    EXPECT_EQ(greedy(h), want);
}

TEST(Greedy, ForcedOnesMayBeFar) {
    std::vector<std::vector<std::int32_t>> rows = {{0}};
    std::vector<OverlapPair> edges;
    const Chosen one = add_chain(rows, edges, 20, 1, 0.9);
    const Chosen two = add_chain(rows, edges, 5, 2, 0.4);
    const HandMade h = hand_made({50, 20, 1}, rows, edges);
    Chosen want(one.rbegin(), one.rend());
    want.push_back(0);
    want.insert(want.end(), two.begin(), two.end());
    EXPECT_EQ(greedy(h, {one.back(), two.back()}), want);
}

TEST(Greedy, CoversEverythingAndStaysConnected) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const HandMade h = test::random_hand_made(seed, 30, 40);
        auto wanted = h.wanted();
        const Chosen chosen = test::greedy_alone(h, h.everyone(), {}, wanted);
        EXPECT_TRUE(h.connected(chosen));
        for (std::int32_t p = 0; p < 40; ++p) {
            EXPECT_EQ(wanted[static_cast<std::size_t>(p)], 0);
            EXPECT_EQ(h.covered_by(chosen, p),
                      h.status[static_cast<std::size_t>(p)] == PieceStatus::covered);
        }
        Chosen sorted = chosen;
        std::sort(sorted.begin(), sorted.end());
        EXPECT_EQ(std::adjacent_find(sorted.begin(), sorted.end()), sorted.end());
    }
}

}  // namespace
}  // namespace vfplan
