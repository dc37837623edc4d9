#include "engine/search/survive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

// Numbers the parts of the columns that are `in`, without the link a - b.
std::vector<std::int32_t> parts(const Problem& p, const std::vector<std::uint8_t>& in,
                                std::int32_t a = -1, std::int32_t b = -1) {
    std::vector<std::int32_t> part(in.size(), -1);
    for (std::int32_t seed = 0; seed < p.columns(); ++seed) {
        if (in[idx(seed)] == 0 || part[idx(seed)] >= 0) continue;
        std::vector<std::int32_t> queue = {seed};
        part[idx(seed)] = seed;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const std::int32_t n : p.near.of(queue[i])) {
                if (in[idx(n)] == 0 || part[idx(n)] >= 0) continue;
                if (std::minmax(queue[i], n) == std::minmax(a, b)) continue;
                part[idx(n)] = seed;
                queue.push_back(n);
            }
        }
    }
    return part;
}

// The definition, column by column and link by link.
bool survives(const Problem& p, const Choice& choice) {
    if (!is_plan(p, choice)) return false;
    const std::vector<std::uint8_t> all(idx(p.columns()), 1);
    std::vector<std::uint8_t> chosen(all.size(), 0);
    for (const std::int32_t c : choice) chosen[idx(c)] = 1;
    for (std::int32_t r = 0; r < p.rows(); ++r) {
        const auto columns = p.columns_of.of(r);
        const auto cover = std::count_if(columns.begin(), columns.end(),
                                         [&](std::int32_t c) { return chosen[idx(c)] != 0; });
        if (cover < std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(columns.size()))) {
            return false;
        }
    }
    for (const std::int32_t lost : choice) {
        std::vector<std::uint8_t> graph = all;
        std::vector<std::uint8_t> plan = chosen;
        graph[idx(lost)] = plan[idx(lost)] = 0;
        const auto of_graph = parts(p, graph);
        const auto of_plan = parts(p, plan);
        for (const std::int32_t a : choice) {
            for (const std::int32_t b : choice) {
                if (a == lost || b == lost || of_graph[idx(a)] != of_graph[idx(b)]) continue;
                if (of_plan[idx(a)] != of_plan[idx(b)]) return false;
            }
        }
    }
    for (const std::int32_t a : choice) {
        for (const std::int32_t b : p.near.of(a)) {
            if (chosen[idx(b)] == 0 || b < a) continue;
            const auto of_graph = parts(p, all, a, b);
            if (of_graph[idx(a)] != of_graph[idx(b)]) continue;
            const auto of_plan = parts(p, chosen, a, b);
            if (of_plan[idx(a)] != of_plan[idx(b)]) return false;
        }
    }
    return true;
}

TEST(Survive, EveryPlanStandsTheLossOfAnyStation) {
    int more = 0;
    for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
        const auto columns = static_cast<std::int32_t>(2 + seed % 40);
        const auto rows = static_cast<std::int32_t>(1 + seed % 25);
        const Problem p = test::random_problem(seed, columns, rows, seed % 3 == 0);
        Choice start;
        for (std::int32_t c = 0; c < columns; ++c) start.push_back(c);
        const Choice plan = survive(p, start, 20, seed);
        ASSERT_TRUE(survives(p, plan)) << "seed " << seed;
        // From the least that is a plan, too.
        for (const std::int32_t c : start) {
            Choice less;
            std::copy_if(plan.begin(), plan.end(), std::back_inserter(less),
                         [&](std::int32_t k) { return k != c; });
            if (less.size() == plan.size() || !is_plan(p, less)) continue;
            const Choice again = survive(p, less, 0, seed);
            ASSERT_TRUE(survives(p, again)) << "seed " << seed << " without " << c;
            ++more;
            break;
        }
    }
    EXPECT_GT(more, 500);
}

TEST(Survive, ComesNearTheFewest) {
    double found = 0;
    double fewest = 0;
    int optimal = 0;
    int cases = 0;
    for (std::uint64_t seed = 1; seed <= 300; ++seed) {
        const auto columns = static_cast<std::int32_t>(5 + seed % 8);
        const Problem p = test::random_problem(seed, columns, 8, seed % 4 == 0);
        std::size_t best = idx(columns);
        test::every_plan(p, [&](const Choice& c) {
            if (c.size() < best && survives(p, c)) best = c.size();
        });
        Choice start;
        for (std::int32_t c = 0; c < columns; ++c) start.push_back(c);
        const Choice plan = survive(p, start, 100, seed);
        ASSERT_GE(plan.size(), best) << "seed " << seed;
        found += static_cast<double>(plan.size());
        fewest += static_cast<double>(best);
        optimal += plan.size() == best ? 1 : 0;
        ++cases;
    }
    std::printf("%d of %d cases with the fewest stations, %.3f of them in the mean\n", optimal,
                cases, found / fewest);
    EXPECT_LT(found / fewest, 1.02);
}

TEST(Survive, FixedStationsStay) {
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const Problem p = test::random_problem(seed, 20, 10, true);
        Choice start;
        for (std::int32_t c = 0; c < p.columns(); ++c) start.push_back(c);
        const Choice plan = survive(p, start, 50, seed);
        for (std::int32_t c = 0; c < p.columns(); ++c) {
            if (p.fixed[idx(c)] == 0) continue;
            EXPECT_TRUE(std::binary_search(plan.begin(), plan.end(), c)) << "seed " << seed;
        }
    }
}

}  // namespace
}  // namespace vfplan
