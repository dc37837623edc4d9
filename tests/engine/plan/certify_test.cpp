#include "engine/plan/certify.h"

#include <gtest/gtest.h>

#include "engine/plan/plan.h"
#include "io/tables/certificate_text.h"
#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

using test::hand_made;
using test::HandMade;
using test::random_hand_made;

Plan plan_of(const HandMade& h, const PlanOptions& options, PlanReport* report = nullptr) {
    PlanReport mine;
    return make_plan(Threads(1), h.input(), options, report == nullptr ? mine : *report);
}

const PlanOptions greedy_alone{PlanMethod::greedy, false, {}};
const PlanOptions refined{PlanMethod::refined, false, {}};
const PlanOptions with_loops{PlanMethod::refined, true, {}};

HandMade two_parts() {
    return hand_made({1, 2, 4, 5, 6, 3}, {{0, 3}, {1, 3}, {2, 3}, {4}}, {{0, 1, 0.5}, {2, 3, 0.6}});
}

// Fewest candidates that cover everything coverable and hang together, by trying all sets.
std::size_t fewest(const HandMade& h) {
    std::size_t best = h.candidates.size();
    for (unsigned set = 0; set < 1U << h.candidates.size(); ++set) {
        Chosen chosen;
        for (std::int32_t c = 0; idx(c) < h.candidates.size(); ++c) {
            if ((set >> static_cast<unsigned>(c) & 1U) != 0) chosen.push_back(c);
        }
        if (chosen.size() >= best || !h.connected(chosen)) continue;
        bool all = true;
        for (std::int32_t p = 0; p < h.pieces() && all; ++p) {
            all = h.status[idx(p)] != PieceStatus::covered || h.covered_by(chosen, p);
        }
        if (all) best = chosen.size();
    }
    return best;
}

TEST(Certify, BoundsEveryPlanAndClosesSmallOnes) {
    std::int64_t open = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(seed);
        const HandMade h = random_hand_made(seed, 11, 12);
        const auto best = static_cast<std::int64_t>(fewest(h));
        for (const PlanOptions& options : {greedy_alone, refined, with_loops}) {
            const Plan plan = plan_of(h, options);
            EXPECT_LE(plan.certificate.bound(), best);
            EXPECT_GE(plan.certificate.bound(), 1);
            open += plan.certificate.bound() < best ? 1 : 0;
        }
        PlanReport report;
        const Plan certified = plan_of(h, {PlanMethod::certified, false, {}, 0, 20}, &report);
        EXPECT_EQ(certified.certificate.bound(), best);
        EXPECT_EQ(report.connected, best);
        EXPECT_EQ(certified.stations.size(), idx(best));
        EXPECT_EQ(plan_of(h, {PlanMethod::certified, true, {}, 0, 20}).certificate.bound(), best);
    }
    EXPECT_GT(open, 10);
}

// Networks are proven side by side.
TEST(Certify, IsTheSameForAnyNumberOfThreads) {
    // Many networks: copies of one after another.
    std::vector<double> lengths;
    std::vector<std::vector<std::int32_t>> rows;
    std::vector<OverlapPair> edges;
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        const HandMade h = random_hand_made(seed, 12, 14);
        const auto first = static_cast<std::int32_t>(rows.size());
        const auto piece = static_cast<std::int32_t>(lengths.size());
        lengths.insert(lengths.end(), h.length_m.begin(), h.length_m.end());
        for (std::int32_t c = 0; c < 12; ++c) {
            rows.emplace_back();
            for (const std::int32_t p : h.rows.row(c)) rows.back().push_back(piece + p);
            h.graph.each(c, [&](std::int32_t n, double overlap) {
                if (n > c) edges.push_back({first + c, first + n, overlap});
            });
        }
    }
    const HandMade h = hand_made(lengths, rows, edges);
    const PlanOptions options{PlanMethod::certified, true, {}, 20, 5};
    PlanReport report;
    const Plan one = make_plan(Threads(1), h.input(), options, report);
    const Plan four = make_plan(Threads(4), h.input(), options, report);
    EXPECT_EQ(one.certificate.networks.size(), 12U);
    EXPECT_EQ(text_of(one.certificate), text_of(four.certificate));
    EXPECT_EQ(one.stations.size(), four.stations.size());
}

// Two networks, each with its own, in numbers of the whole table.
TEST(Certify, NetworksHaveProofsOfTheirOwn) {
    const Plan plan = plan_of(two_parts(), {PlanMethod::certified, false, {}, 10, 20});
    std::int32_t networks = 0;
    for (const Station& s : plan.stations) networks = std::max(networks, s.network + 1);
    ASSERT_EQ(networks, 2);
    ASSERT_EQ(plan.certificate.networks.size(), 2U);
    EXPECT_EQ(plan.certificate.bound(), static_cast<std::int64_t>(plan.stations.size()));
    for (std::size_t n = 0; n < 2; ++n) {
        const std::int32_t root = plan.certificate.networks[n].root_piece;
        ASSERT_GE(root, 0);
        bool covered = false;
        for (const Station& s : plan.stations) {
            covered = covered || (s.network == static_cast<std::int32_t>(n) &&
                                  two_parts().covers(s.candidate, root));
        }
        EXPECT_TRUE(covered);
    }
}

}  // namespace
}  // namespace vfplan
