#include "engine/search/improve.h"

#include <gtest/gtest.h>

#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

using test::count_cycles;
using test::every_plan;
using test::fewest;
using test::off_cycles;
using test::random_problem;

Choice everything(const Problem& p) {
    return test::choice_of((std::uint32_t{1} << p.columns()) - 1);
}

TEST(Improve, FindsTheFewestStationsOfSmallProblems) {
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p =
            random_problem(seed, 4 + static_cast<std::int32_t>(seed % 10), 12, seed % 3 == 0);
        const Choice found = improve(p, everything(p), {400, seed});
        ASSERT_TRUE(is_plan(p, found));
        ASSERT_EQ(found.size(), fewest(p));
    }
}

TEST(Improve, PutsStationsOnCyclesFirst) {
    std::int64_t more = 0;
    std::int64_t worse = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        Problem p = random_problem(seed, 4 + static_cast<std::int32_t>(seed % 8), 12, false);
        count_cycles(p);
        std::pair<std::int64_t, std::size_t> best(1000, 0);
        every_plan(p, [&](const Choice& c) {
            best = std::min(best, std::pair(off_cycles(p, c), c.size()));
        });
        const Choice found = improve(p, everything(p), {400, seed});
        ASSERT_TRUE(is_plan(p, found));
        ASSERT_EQ(off_cycles(p, found), best.first);
        ASSERT_GE(found.size(), best.second);
        worse += found.size() > best.second ? 1 : 0;
        more += best.second > fewest(p) ? 1 : 0;
    }
    EXPECT_GT(more, 100);
    EXPECT_LT(worse, 10);
}

TEST(Improve, IsNeverWorseThanItsStartAndAlwaysTheSame) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p = random_problem(seed, 60, 200, true);
        Choice start;
        for (std::int32_t c = 0; c < p.columns(); ++c) start.push_back(c);
        Choice before = improve(p, start, {0, seed});
        EXPECT_TRUE(is_plan(p, before));
        const Choice after = improve(p, before, {300, seed});
        EXPECT_TRUE(is_plan(p, after));
        EXPECT_LE(after.size(), before.size());
        EXPECT_EQ(improve(p, before, {300, seed}), after);
        // Nothing in it could just go.
        for (const std::int32_t c : after) {
            Choice less = after;
            std::erase(less, c);
            EXPECT_TRUE(less.empty() || !is_plan(p, less));
        }
    }
}

}  // namespace
}  // namespace vfplan
