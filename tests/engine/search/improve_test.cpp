#include "engine/search/improve.h"

#include <gtest/gtest.h>

#include "engine/search/choosing.h"
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

// Stations that stand too near by each other are counted through all changes, and cost half a one.
TEST(Improve, KeepsStationsApartWhereThatCostsLittle) {
    int fewer = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        Problem p = random_problem(seed, 5 + static_cast<std::int32_t>(seed % 9), 12, false);
        const auto pairs = [&](const Choice& c) {
            std::int64_t out = 0;
            for (std::size_t i = 0; i < c.size(); ++i) {
                for (std::size_t k = i + 1; k < c.size(); ++k) {
                    out += (c[i] + c[k]) % 3 == 0 ? 1 : 0;
                }
            }
            return out;
        };
        const Choice careless = improve(p, everything(p), {400, seed});
        for (std::int32_t a = 0; a < p.columns(); ++a) {
            for (std::int32_t b = 0; b < p.columns(); ++b) {
                if (a != b && (a + b) % 3 == 0) p.beside.to.push_back(b);
            }
            p.beside.end_list();
        }
        Choosing choosing(p);
        Choice chosen;
        for (const std::int32_t c : everything(p)) {
            choosing.add(c);
            chosen.push_back(c);
            ASSERT_EQ(choosing.pairs_beside(), pairs(chosen));
        }
        choosing.remove(chosen.front());
        choosing.back_to(0);
        ASSERT_EQ(choosing.pairs_beside(), 0);
        double best = 1000;
        every_plan(p, [&](const Choice& c) {
            best =
                std::min(best, static_cast<double>(c.size()) + 0.5 * static_cast<double>(pairs(c)));
        });
        const Choice found = improve(p, everything(p), {600, seed});
        ASSERT_TRUE(is_plan(p, found));
        ASSERT_EQ(static_cast<double>(found.size()) + 0.5 * static_cast<double>(pairs(found)),
                  best);
        fewer += pairs(found) < pairs(careless) ? 1 : 0;
    }
    EXPECT_GT(fewer, 20);
}

}  // namespace
}  // namespace vfplan
