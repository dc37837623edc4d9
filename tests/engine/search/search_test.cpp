#include "engine/search/search.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/search/structure.h"
#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

// Points in a square: what lies within 1 of a column is covered or near.
Problem scattered(std::uint64_t seed, std::int32_t columns, std::int32_t rows, double side) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> place(0, side);
    std::vector<std::pair<double, double>> at;
    for (std::int32_t i = 0; i < columns + rows; ++i) {
        const double x = place(random);
        at.emplace_back(x, place(random));
    }
    const auto within = [&](std::size_t a, std::size_t b, double far) {
        const double dx = at[a].first - at[b].first;
        const double dy = at[a].second - at[b].second;
        return dx * dx + dy * dy < far * far;
    };
    Problem p;
    for (std::size_t r = idx(columns); r < at.size(); ++r) {
        for (std::int32_t c = 0; c < columns; ++c) {
            if (within(idx(c), r, 1)) p.columns_of.to.push_back(c);
        }
        if (p.columns_of.to.size() != idx(p.columns_of.begin.back())) p.columns_of.end_list();
    }
    p.rows_of = transposed(p.columns_of, columns);
    for (std::int32_t c = 0; c < columns; ++c) {
        for (std::int32_t n = 0; n < columns; ++n) {
            if (n != c && within(idx(c), idx(n), 1.2)) p.near.to.push_back(n);
        }
        p.near.end_list();
        p.fixed.push_back(random() % 100 == 0 ? 1 : 0);
    }
    return p;
}

Choice everything(const Problem& p) {
    Choice all;
    for (std::int32_t c = 0; c < p.columns(); ++c) all.push_back(c);
    return all;
}

std::int64_t loose_of(const Problem& p, const Choice& choice) {
    Choosing choosing(p);
    for (const std::int32_t c : choice) choosing.add(c);
    return Structure(p, choosing).find_cycles();
}

TEST(Search, ByWindowsKeepsThePlanRightAndMakesItBetter) {
    const Problem p = scattered(3, 4000, 4000, 32);
    ASSERT_TRUE(is_plan(p, everything(p)));
    const Choice thinned = search(Threads(1), p, everything(p), {0, 1});
    ASSERT_TRUE(is_plan(p, thinned));
    ASSERT_GT(thinned.size(), 450U);  // so that there are windows
    const Choice better = search(Threads(1), p, thinned, {12, 1});
    EXPECT_TRUE(is_plan(p, better));
    EXPECT_LT(better.size(), thinned.size() * 95 / 100);
    EXPECT_EQ(search(Threads(3), p, thinned, {12, 1}), better);
}

TEST(Search, ByWindowsLeavesNothingLoose) {
    Problem p = scattered(3, 4000, 4000, 32);
    ASSERT_TRUE(is_plan(p, everything(p)));
    const Threads threads(2);
    const Choice connected = search(threads, p, everything(p), {4, 1});
    // So dense that no single link's loss parts anything but the ends.
    p.block.assign(idx(p.columns()), 0);
    p.loose.assign(idx(p.columns()), 1);
    for (std::int32_t c = 0; c < p.columns(); ++c) {
        if (p.near.of(c).size() < 2) p.block[idx(c)] = c + 1;
    }
    ASSERT_GT(loose_of(p, connected), 20);
    const Choice closed = search(threads, p, connected, {4, 1});
    EXPECT_TRUE(is_plan(p, closed));
    EXPECT_EQ(loose_of(p, closed), 0);
    EXPECT_LT(closed.size(), connected.size() * 5 / 4);
}

}  // namespace
}  // namespace vfplan
