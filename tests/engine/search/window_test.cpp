#include "engine/search/window.h"

#include <gtest/gtest.h>

#include <map>

#include "engine/search/dice.h"
#include "engine/search/improve.h"
#include "engine/search/structure.h"
#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

using test::count_cycles;
using test::every_plan;
using test::off_cycles;
using test::random_problem;

std::int64_t loose_of(const Problem& p, const Choice& choice) {
    Choosing choosing(p);
    for (const std::int32_t c : choice) choosing.add(c);
    return Structure(p, choosing).find_cycles();
}

// A plan with some stations more than it needs, and some of them around one.
struct Cut {
    Choosing plan;
    std::vector<std::int32_t> stations;

    Cut(const Problem& p, Dice& dice) : plan(p) {
        Choice all;
        for (std::int32_t c = 0; c < p.columns(); ++c) all.push_back(c);
        Choice best = improve(p, all, {static_cast<std::int64_t>(dice.below(3)), dice.next()});
        for (const std::int32_t c : best) plan.add(c);
        for (std::int32_t c = 0; c < p.columns(); ++c) {
            if (!plan.is_chosen(c) && dice.below(4) == 0 && !plan.links(c).empty()) plan.add(c);
        }
        const auto size = static_cast<std::int64_t>(plan.chosen().size());
        const std::size_t most = idx(1 + dice.below(size));
        std::vector<std::uint8_t> met(idx(p.columns()), 0);
        stations.push_back(plan.chosen()[idx(dice.below(size))]);
        met[idx(stations.front())] = 1;
        for (std::size_t i = 0; i < stations.size() && stations.size() < most; ++i) {
            for (const std::int32_t n : plan.links(stations[i])) {
                if (met[idx(n)] != 0 || stations.size() >= most) continue;
                met[idx(n)] = 1;
                stations.push_back(n);
            }
        }
    }

    // The whole plan with a plan of the window in place of its stations.
    Choice with(const Window& w, const Choice& choice) const {
        Choice out;
        for (const std::int32_t c : plan.chosen()) {
            if (std::find(stations.begin(), stations.end(), c) == stations.end()) out.push_back(c);
        }
        for (const std::int32_t c : choice) {
            if (w.column[idx(c)] >= 0) out.push_back(w.column[idx(c)]);
        }
        std::sort(out.begin(), out.end());
        return out;
    }
};

TEST(Window, APlanOfItMakesAPlanOfTheWhole) {
    std::size_t tried = 0;
    std::size_t still = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        SCOPED_TRACE(seed);
        const Problem whole = random_problem(seed, 14, 12, seed % 3 == 0);
        Dice dice(seed);
        const Cut cut(whole, dice);
        const Window w = make_window(whole, cut.plan, cut.stations);
        ASSERT_TRUE(is_plan(w.problem, w.start));
        ASSERT_EQ(cut.with(w, w.start), cut.plan.choice());
        still += cut.stations.size() < cut.plan.chosen().size() ? 1 : 0;
        every_plan(w.problem, [&](const Choice& c) {
            ASSERT_TRUE(is_plan(whole, cut.with(w, c)));
            ++tried;
        });
    }
    EXPECT_GT(tried, 20000U);
    EXPECT_GT(still, 250U);
}

TEST(Window, CountsLooseStationsAsTheWholeDoes) {
    std::size_t tried = 0;
    std::size_t different = 0;
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
        SCOPED_TRACE(seed);
        Problem whole = random_problem(seed, 15, 10, seed % 3 == 0);
        count_cycles(whole);
        Dice dice(seed);
        const Cut cut(whole, dice);
        const Window w = make_window(whole, cut.plan, cut.stations);
        const std::int64_t rest =
            off_cycles(whole, cut.plan.choice()) - loose_of(w.problem, w.start);
        ASSERT_EQ(loose_of(whole, cut.plan.choice()), off_cycles(whole, cut.plan.choice()));
        ASSERT_GE(rest, 0);
        std::map<std::int64_t, int> counts;
        every_plan(w.problem, [&](const Choice& c) {
            const std::int64_t loose = loose_of(w.problem, c);
            ASSERT_EQ(off_cycles(whole, cut.with(w, c)), loose + rest);
            ++counts[loose];
            ++tried;
        });
        different += counts.size() > 1 ? 1 : 0;
    }
    EXPECT_GT(tried, 5000U);
    EXPECT_GT(different, 50U);
}

// Large plans are searched in windows of windows.
TEST(Window, OfAWindowIsOneOfTheWhole) {
    std::size_t tried = 0;
    std::size_t different = 0;
    for (std::uint64_t seed = 0; seed < 1000; ++seed) {
        SCOPED_TRACE(seed);
        Problem whole = random_problem(seed, 16, 10, seed % 3 == 0);
        if (seed % 4 != 0) count_cycles(whole);
        Dice dice(seed);
        const Cut cut(whole, dice);
        const Window outer = make_window(whole, cut.plan, cut.stations);
        Choosing plan(outer.problem);
        for (const std::int32_t c : outer.start) plan.add(c);
        std::vector<std::int32_t> stations;
        std::vector<std::int32_t> rest;
        for (const std::int32_t c : outer.start) {
            const bool inside = outer.column[idx(c)] >= 0 && dice.below(2) == 0;
            (inside ? stations : rest).push_back(c);
        }
        if (stations.empty()) continue;
        const Window inner = make_window(outer.problem, plan, stations);
        ASSERT_TRUE(is_plan(inner.problem, inner.start));
        const bool cycles = !whole.loose.empty();
        const auto count = [&](const Problem& p, const Choice& c) {
            return cycles ? loose_of(p, c) : 0;
        };
        const std::int64_t still =
            count(whole, cut.plan.choice()) - count(inner.problem, inner.start);
        std::map<std::int64_t, int> counts;
        every_plan(inner.problem, [&](const Choice& c) {
            Choice there = rest;
            for (const std::int32_t i : c) {
                if (inner.column[idx(i)] >= 0) there.push_back(inner.column[idx(i)]);
            }
            const Choice then = cut.with(outer, there);
            ASSERT_TRUE(is_plan(whole, then));
            const std::int64_t loose = count(inner.problem, c);
            ASSERT_EQ(count(whole, then), loose + still);
            ++counts[loose];
            ++tried;
        });
        different += counts.size() > 1 ? 1 : 0;
    }
    EXPECT_GT(tried, 10000U);
    EXPECT_GT(different, 100U);
}

// 0 and 1 cover all; 2 and 3 do nothing but close a cycle with 0. Where both are dropped at once,
// one node without any link is left of their window.
TEST(Window, MayLoseAllItsStations) {
    Problem whole;
    whole.rows_of = {{0, 1, 2, 2, 2, 2}, {0, 1}};
    whole.columns_of = transposed(whole.rows_of, 2);
    whole.near = {{0, 4, 6, 8, 10, 12}, {1, 2, 3, 4, 0, 4, 0, 3, 0, 2, 0, 1}};
    whole.fixed.assign(5, 0);
    count_cycles(whole);
    Choosing plan(whole);
    for (std::int32_t c = 0; c < 4; ++c) plan.add(c);
    const Window w = make_window(whole, plan, {2, 3});
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        SCOPED_TRACE(seed);
        ASSERT_TRUE(is_plan(w.problem, improve(w.problem, w.start, {20, seed, seed % 2 == 0})));
    }
}

TEST(Window, IsMadeBetterWithoutLossToTheWhole) {
    std::size_t empty = 0;
    std::size_t better = 0;
    for (std::uint64_t seed = 0; seed < 3000; ++seed) {
        SCOPED_TRACE(seed);
        Problem whole = random_problem(seed, 15, 10, seed % 3 == 0);
        count_cycles(whole);
        Dice dice(seed);
        const Cut cut(whole, dice);
        const Window w = make_window(whole, cut.plan, cut.stations);
        const Choice found = improve(w.problem, w.start, {20, seed, false});
        const Choice then = cut.with(w, found);
        ASSERT_TRUE(is_plan(whole, then));
        const auto cost = [&](const Choice& c) {
            return static_cast<std::int64_t>(c.size()) + 2 * off_cycles(whole, c);
        };
        ASSERT_LE(cost(then), cost(cut.plan.choice()));
        better += cost(then) < cost(cut.plan.choice()) ? 1 : 0;
        empty += found.size() == 1 && w.column[idx(found.front())] < 0 ? 1 : 0;
    }
    EXPECT_GT(better, 1000U);
    EXPECT_GT(empty, 20U);
}

}  // namespace
}  // namespace vfplan
