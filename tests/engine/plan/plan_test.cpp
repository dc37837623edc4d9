// From tables to plans: networks, pruning, loops, bound.
#include "engine/plan/plan.h"

#include <gtest/gtest.h>

#include <set>

#include "engine/graphs/cuts.h"
#include "engine/plan/link_ratios.h"
#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

using test::hand_made;
using test::HandMade;
using test::random_hand_made;

std::vector<std::int32_t> candidates_of(const Plan& plan, std::int32_t network) {
    std::vector<std::int32_t> out;
    for (const Station& s : plan.stations) {
        if (s.network == network) out.push_back(s.candidate);
    }
    return out;
}

Plan plan_of(const HandMade& h, const PlanOptions& options, PlanReport* report = nullptr) {
    PlanReport mine;
    return make_plan(Threads(1), h.input(), options, report == nullptr ? mine : *report);
}

const PlanOptions greedy_alone{PlanMethod::greedy, false, {}};
const PlanOptions refined{PlanMethod::refined, false, {}};
const PlanOptions with_loops{PlanMethod::refined, true, {}};

// Components {0, 1} and {2, 3}; the second can cover more. Piece 3 is seen from both, piece 5
// from nowhere.
HandMade two_parts() {
    return hand_made({1, 2, 4, 5, 6, 3}, {{0, 3}, {1, 3}, {2, 3}, {4}}, {{0, 1, 0.5}, {2, 3, 0.6}});
}

TEST(Planner, EachComponentGetsItsNetworkTheLargestFirst) {
    const Plan plan = plan_of(two_parts(), greedy_alone);
    EXPECT_EQ(candidates_of(plan, 0), (std::vector<std::int32_t>{2, 3}));
    EXPECT_EQ(candidates_of(plan, 1), (std::vector<std::int32_t>{1, 0}));
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        EXPECT_EQ(plan.stations[i].order, static_cast<std::int32_t>(i));
    }
}

TEST(Planner, PiecesOfOtherNetworksAreUnreached) {
    const Plan plan = plan_of(two_parts(), refined);
    EXPECT_EQ(plan.pieces,
              (std::vector<PieceStatus>{PieceStatus::unreached, PieceStatus::unreached,
                                        PieceStatus::covered, PieceStatus::covered,
                                        PieceStatus::covered, PieceStatus::no_viewpoint}));
}

TEST(Planner, ReasonsForBeingUncoverableAreKept) {
    HandMade h = two_parts();
    h.status[5] = PieceStatus::off_candidates;
    EXPECT_EQ(plan_of(h, refined).pieces[5], PieceStatus::off_candidates);
}

// Tables say of a piece that no cell sees it, and the pool found a cell that does: a station covers
// it all the same, and verify asks for one.
TEST(Planner, WhatOnlyThePoolSeesIsCovered) {
    HandMade h = hand_made({1, 2, 4, 7}, {{0}, {1}, {1, 2}, {3}}, {{0, 1, 0.5}, {1, 2, 0.6}});
    h.candidates[2].kind = h.candidates[3].kind = CandidateKind::pool;
    h.status[2] = h.status[3] = PieceStatus::no_viewpoint;
    for (const PlanOptions& options : {greedy_alone, refined, with_loops}) {
        const Plan plan = plan_of(h, options);
        EXPECT_EQ(plan.pieces[2], PieceStatus::covered);
        EXPECT_EQ(plan.pieces[3], PieceStatus::no_viewpoint) << "off all networks";
    }
}

TEST(Planner, LengthsAreCountedOnce) {
    const Plan plan = plan_of(two_parts(), greedy_alone);
    ASSERT_EQ(plan.stations.size(), 4U);
    const std::vector<double> fresh = {9, 6, 2, 1};
    const std::vector<double> seen = {9, 6, 7, 6};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_DOUBLE_EQ(plan.stations[i].new_length_m, fresh[i]);
        EXPECT_DOUBLE_EQ(plan.stations[i].seen_length_m, seen[i]);
    }
}

TEST(Planner, ComponentThatAddsNothingGetsNoNetwork) {
    const HandMade h = hand_made({5, 6}, {{0, 1}, {0}, {1}}, {{1, 2, 0.5}});
    const Plan plan = plan_of(h, greedy_alone);
    ASSERT_EQ(plan.stations.size(), 1U);
    EXPECT_EQ(plan.stations[0].candidate, 0);
}

TEST(Planner, LinksJoinStationsInOrderWithAllRatios) {
    const HandMade h = two_parts();
    Plan plan = plan_of(h, greedy_alone);
    ASSERT_EQ(plan.links.size(), 2U);
    EXPECT_EQ(plan.links[0].from, 0);
    EXPECT_EQ(plan.links[0].to, 1);
    EXPECT_EQ(plan.links[0].overlap, 0.6);
    EXPECT_EQ(plan.links[1].from, 2);
    EXPECT_EQ(plan.links[1].to, 3);
    add_ratios(
        h.input(),
        [&](std::int64_t from, std::int64_t count) {
            const auto begin = h.rows.angle_rad.begin() + from;
            return std::vector<float>(begin, begin + count);
        },
        plan);
    // Stations 2 and 3 are candidates 1 and 0: 5 m in common of 7 and 6.
    EXPECT_DOUBLE_EQ(plan.links[1].ratios[0], 5 / 6.0);
    EXPECT_DOUBLE_EQ(plan.links[1].ratios[1], 10 / 13.0);
    EXPECT_DOUBLE_EQ(plan.links[1].ratios[2], 5 / 8.0);
    // 0.1 from every piece: one piece in common of two and two.
    EXPECT_DOUBLE_EQ(plan.links[1].ratios[3], 0.5);
    EXPECT_DOUBLE_EQ(plan.links[1].ratios[4], 0.5);
}

// Row by row as from pairs of rows, the angles fetched in order and none twice.
TEST(Planner, RatiosOfLinksAreThoseOfTheirRows) {
    HandMade h = random_hand_made(7, 40, 50);
    for (std::size_t i = 0; i < h.rows.angle_rad.size(); ++i) {
        h.rows.angle_rad[i] = 0.01F * static_cast<float>(1 + i * 7919 % 97);
    }
    Plan plan = plan_of(h, with_loops);
    ASSERT_GT(plan.links.size(), 5U);
    std::int64_t last = 0;
    add_ratios(
        h.input(),
        [&](std::int64_t from, std::int64_t count) {
            EXPECT_GE(from, last);
            last = from + count;
            const auto begin = h.rows.angle_rad.begin() + from;
            return std::vector<float>(begin, begin + count);
        },
        plan);
    for (const Link& l : plan.links) {
        const std::int32_t a = plan.stations[static_cast<std::size_t>(l.from)].candidate;
        const std::int32_t b = plan.stations[static_cast<std::size_t>(l.to)].candidate;
        const SeenRow of_a = h.rows.seen(a, h.length_m);
        const SeenRow of_b = h.rows.seen(b, h.length_m);
        for (const OverlapFormula& f : overlap_ratios) {
            EXPECT_EQ(l.ratios[static_cast<std::size_t>(f.ratio)],
                      f.of(seen_total(of_a), seen_total(of_b), seen_jointly(of_a, of_b)));
        }
    }
}

// A second network must find the work space as the first one did.
TEST(Planner, NetworksShareAWorkspaceWithoutSeeingEachOther) {
    const HandMade h = random_hand_made(3, 30, 40);
    Workspace work(h.graph);
    for (int round = 0; round < 2; ++round) {
        auto wanted = h.wanted();
        const Chosen chosen = choose_greedily(h.input(), h.everyone(), {}, wanted, work);
        const Workspace fresh(h.graph);
        EXPECT_EQ(work.mark, fresh.mark);
        EXPECT_EQ(work.overlap, fresh.overlap);
        EXPECT_EQ(work.step, fresh.step);
        EXPECT_EQ(work.hops, fresh.hops);
        EXPECT_EQ(work.before, fresh.before);
        if (round == 0) continue;
        close_loops(h.input(), chosen, work);
        EXPECT_EQ(work.mark, fresh.mark);
        EXPECT_EQ(work.step, fresh.step);
        EXPECT_EQ(work.before, fresh.before);
    }
}

TEST(Planner, RequiredAndExistingStay) {
    // 0 sees everything; 2 (behind 1) sees nothing new but is required.
    HandMade h = hand_made({9, 1}, {{0, 1}, {}, {1}, {0}}, {{0, 1, 0.5}, {1, 2, 0.5}, {0, 3, 0.9}});
    EXPECT_EQ(plan_of(h, refined).stations.size(), 1U);
    for (const CandidateKind kind : {CandidateKind::required, CandidateKind::existing}) {
        h.candidates[2].kind = kind;
        const auto stations = candidates_of(plan_of(h, refined), 0);
        EXPECT_EQ(std::set(stations.begin(), stations.end()), (std::set<std::int32_t>{0, 1, 2}));
    }
    // Even alone, seeing nothing.
    HandMade lonely = hand_made({1}, {{0}, {}}, {});
    lonely.candidates[1].kind = CandidateKind::required;
    EXPECT_EQ(plan_of(lonely, refined).stations.size(), 2U);
}

TEST(Planner, RefinedNeverHasMoreStationsAndCoversTheSame) {
    std::int64_t fewer = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const HandMade h = random_hand_made(seed, 40, 50);
        PlanReport report;
        const Plan a = plan_of(h, greedy_alone);
        const Plan b = plan_of(h, refined, &report);
        EXPECT_EQ(a.pieces, b.pieces);
        EXPECT_EQ(report.greedy_stations, static_cast<std::int64_t>(a.stations.size()));
        EXPECT_EQ(report.connected, static_cast<std::int64_t>(b.stations.size()));
        EXPECT_TRUE(h.connected(candidates_of(b, 0)));
        fewer += report.greedy_stations - report.connected;
    }
    EXPECT_GT(fewer, 20);
}

TEST(Loops, FewestCandidatesThenTheHighestOverlap) {
    // Stations 0 - 1. Candidates 2 and 3 close the cycle alone, 4 - 5 together.
    const std::vector<OverlapPair> edges = {{0, 1, 0.5},  {0, 2, 0.4}, {1, 2, 0.4}, {0, 3, 0.9},
                                            {1, 3, 0.35}, {0, 4, 1},   {4, 5, 1},   {1, 5, 1}};
    const HandMade h = hand_made({1}, {{0}, {}, {}, {}, {}, {}}, edges);
    EXPECT_EQ(test::loops_alone(h, {0, 1}), (Chosen{0, 1, 2}));  // its weakest link is stronger
    const HandMade longer =
        hand_made({1}, {{0}, {}, {}, {}, {}, {}}, {{0, 1, 0.5}, {0, 4, 1}, {4, 5, 1}, {1, 5, 1}});
    const Chosen closed = test::loops_alone(longer, {0, 1});
    EXPECT_EQ(std::set(closed.begin(), closed.end()), (std::set<std::int32_t>{0, 1, 4, 5}));
}

TEST(Loops, NothingIsAddedWhereAllIsWellOrNothingHelps) {
    const HandMade triangle = hand_made(
        {1}, {{0}, {}, {}, {}}, {{0, 1, 0.5}, {0, 2, 0.5}, {1, 2, 0.5}, {0, 3, 0.5}, {1, 3, 0.5}});
    EXPECT_EQ(test::loops_alone(triangle, {0, 1, 2}), (Chosen{0, 1, 2}));
    const HandMade path = hand_made({1}, {{0}, {}, {}}, {{0, 1, 0.5}, {1, 2, 0.5}});
    EXPECT_EQ(test::loops_alone(path, {0, 1}), (Chosen{0, 1}));
    EXPECT_EQ(test::loops_alone(path, {1}), (Chosen{1}));
}

TEST(Loops, StationsStayLooseOnlyWhereNoOtherWayLeadsToTheNetwork) {
    std::size_t added = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const HandMade h = random_hand_made(seed, 40, 30);
        auto wanted = h.wanted();
        const Chosen before = test::greedy_alone(h, h.everyone(), {}, wanted);
        const Chosen after = test::loops_alone(h, before);
        ASSERT_TRUE(std::equal(before.begin(), before.end(), after.begin()));
        added += after.size() - before.size();
        EXPECT_TRUE(h.connected(after));
        Chosen nodes = after;
        std::sort(nodes.begin(), nodes.end());
        const Cuts cuts = find_cuts(induced(h.graph, nodes));
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            if (cuts.on_cycle[i] != 0 || nodes.size() < 2) continue;
            // From here through candidates that are no stations: no other station may be met.
            std::set<std::int32_t> reached = {nodes[i]};
            std::vector<std::int32_t> stack = {nodes[i]};
            while (!stack.empty()) {
                const std::int32_t c = stack.back();
                stack.pop_back();
                h.graph.each(c, [&](std::int32_t n, double) {
                    const bool station = std::binary_search(nodes.begin(), nodes.end(), n);
                    EXPECT_FALSE(station && n != nodes[i] && c != nodes[i]);
                    if (!station && reached.insert(n).second) stack.push_back(n);
                });
            }
        }
    }
    EXPECT_GT(added, 10U);
}

TEST(Planner, LoopsAreCountedBeforeAndAfter) {
    const HandMade h = hand_made({5, 4, 1}, {{0}, {1}, {2}, {}},
                                 {{0, 1, 0.5}, {1, 2, 0.5}, {1, 3, 0.5}, {2, 3, 0.5}});
    PlanReport report;
    const Plan plan = plan_of(h, with_loops, &report);
    EXPECT_EQ(report.connected, 3);
    EXPECT_EQ(report.off_cycle_before, 3);
    EXPECT_EQ(report.off_cycle_after, 1);  // 0 hangs on 1 whatever is added
    EXPECT_EQ(plan.stations.size(), 4U);
    EXPECT_EQ(plan_of(h, refined).stations.size(), 3U);
}

}  // namespace
}  // namespace vfplan
