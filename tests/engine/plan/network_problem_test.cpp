#include "engine/plan/network_problem.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "engine/search/reduce.h"
#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

test::HandMade tables(std::uint64_t seed) {
    return test::random_hand_made(seed, 5 + static_cast<std::int32_t>(seed % 12), 60);
}

bool equal(const Sparse& a, const Sparse& b) { return a.begin == b.begin && a.to == b.to; }

TEST(NetworkProblems, HaveOneRowForWhatTheSameCandidatesCover) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        const test::HandMade h = tables(seed);
        std::vector<std::int32_t> owner(h.length_m.size());
        for (std::size_t p = 0; p < owner.size(); ++p) owner[p] = p % 4 == 0 ? 1 : 0;
        std::map<std::vector<std::int32_t>, std::vector<std::int32_t>> pieces_of;
        for (std::int32_t p = 0; p < h.pieces(); ++p) {
            std::vector<std::int32_t> by;
            for (const std::int32_t c : h.everyone()) {
                if (h.covers(c, p)) by.push_back(c);
            }
            if (owner[idx(p)] == 0 && !by.empty()) pieces_of[by].push_back(p);
        }
        const PlanInput in = h.input();
        NetworkProblems problems(in);
        const Problem p =
            problems.of(h.everyone(), owner, 0, std::vector<std::uint8_t>(h.candidates.size(), 0),
                        ProblemRows::all);
        ASSERT_EQ(idx(p.rows()), pieces_of.size());
        for (std::int32_t r = 0; r < p.rows(); ++r) {
            const auto list = p.columns_of.of(r);
            const auto found = pieces_of.find({list.begin(), list.end()});
            ASSERT_NE(found, pieces_of.end());
            const std::int32_t piece = problems.pieces()[idx(r)];
            ASSERT_TRUE(std::binary_search(found->second.begin(), found->second.end(), piece));
        }
        ASSERT_TRUE(equal(p.rows_of, transposed(p.columns_of, p.columns())));
        ASSERT_EQ(p.near.to, h.graph.to);
    }
}

// How much is looked at at once changes nothing.
TEST(NetworkProblems, ComeOutTheSameInParts) {
    std::size_t parts_differ = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        const test::HandMade h = tables(seed);
        const PlanInput in = h.input();
        const std::vector<std::int32_t> owner(h.length_m.size(), 0);
        const std::vector<std::uint8_t> fixed(h.candidates.size(), 0);
        NetworkProblems whole(in);
        const Problem all = whole.of(h.everyone(), owner, 0, fixed, ProblemRows::all);
        const std::vector<std::int32_t> pieces = whole.pieces();
        const std::vector<std::int32_t> needed = needed_rows(all);
        for (const std::int64_t most : {1, 40, 150}) {
            NetworkProblems parts(in, most);
            const Problem again = parts.of(h.everyone(), owner, 0, fixed, ProblemRows::all);
            ASSERT_TRUE(equal(again.columns_of, all.columns_of));
            ASSERT_EQ(parts.pieces(), pieces);
            for (NetworkProblems* problems : {&whole, &parts}) {
                const Problem p = problems->of(h.everyone(), owner, 0, fixed, ProblemRows::needed);
                ASSERT_EQ(idx(p.rows()), needed.size());
                for (std::int32_t r = 0; r < p.rows(); ++r) {
                    ASSERT_TRUE(
                        std::ranges::equal(p.columns_of.of(r), all.columns_of.of(needed[idx(r)])));
                    ASSERT_EQ(problems->pieces()[idx(r)], pieces[idx(needed[idx(r)])]);
                }
                ASSERT_TRUE(equal(p.rows_of, transposed(p.columns_of, p.columns())));
            }
            parts_differ += needed.size() < idx(all.rows()) ? 1 : 0;
        }
    }
    EXPECT_GT(parts_differ, 300U);
}

}  // namespace
}  // namespace vfplan
