#include "engine/search/settle.h"

#include <gtest/gtest.h>

#include <numeric>

#include "engine/search/improve.h"
#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

using test::count_cycles;
using test::off_cycles;
using test::random_problem;

// Places that differ in nothing but their own score: the sum may only rise.
TEST(Settle, MovesToBetterPlacesAndKeepsThePlan) {
    int moved = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        SCOPED_TRACE(seed);
        Problem p =
            random_problem(seed, 6 + static_cast<std::int32_t>(seed % 12), 12, seed % 3 == 0);
        const bool cycles = seed % 2 == 0;
        if (cycles) count_cycles(p);
        Choice all(idx(p.columns()));
        std::iota(all.begin(), all.end(), 0);
        const Choice start = improve(p, all, {100, seed});
        const auto worth = [&](std::int32_t c) { return static_cast<double>(c * 7919 % 101); };
        const Choice found = settle(
            p, start, [&](std::int32_t c, const Choosing&, std::int32_t) { return worth(c); });
        ASSERT_TRUE(is_plan(p, found));
        ASSERT_LE(found.size(), start.size());
        if (cycles) {
            ASSERT_LE(off_cycles(p, found), off_cycles(p, start));
        }
        if (found.size() < start.size()) continue;
        double before = 0;
        double after = 0;
        for (const std::int32_t c : start) before += worth(c);
        for (const std::int32_t c : found) after += worth(c);
        ASSERT_GE(after, before);
        moved += found != start ? 1 : 0;
        EXPECT_EQ(settle(p, start,
                         [&](std::int32_t c, const Choosing&, std::int32_t) { return worth(c); }),
                  found);
    }
    EXPECT_GT(moved, 100);
}

// Three places in a row, all of which cover the one row: the station goes where it scores most, but
// not from a place that must stand.
TEST(Settle, LeavesWhatIsFixed) {
    for (const bool fixed : {false, true}) {
        Problem p;
        for (std::int32_t c = 0; c < 4; ++c) {
            p.rows_of.to.push_back(c < 3 ? 0 : 1);
            p.rows_of.end_list();
            for (std::int32_t n = 0; n < 4; ++n) {
                if (n != c) p.near.to.push_back(n);
            }
            p.near.end_list();
        }
        p.columns_of = transposed(p.rows_of, 2);
        p.fixed = {static_cast<std::uint8_t>(fixed), 0, 0, 0};
        const auto score = [](std::int32_t c, const Choosing&, std::int32_t) {
            return static_cast<double>(c);
        };
        EXPECT_EQ(settle(p, {0, 3}, score), fixed ? (Choice{0, 3}) : (Choice{2, 3}));
    }
}

}  // namespace
}  // namespace vfplan
