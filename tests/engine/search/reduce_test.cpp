#include "engine/search/reduce.h"

#include <gtest/gtest.h>

#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

using test::every_plan;
using test::fewest;
using test::random_problem;

TEST(Reduce, KeepsABestPlanAndEveryPlanIsOneOfTheWhole) {
    std::size_t gone = 0;
    std::size_t rows_gone = 0;
    for (std::uint64_t seed = 0; seed < 600; ++seed) {
        SCOPED_TRACE(seed);
        const Problem whole =
            random_problem(seed, 4 + static_cast<std::int32_t>(seed % 8), 10, seed % 3 == 0);
        const Reduced small = reduce(whole);
        gone += small.gone.size();
        rows_gone += idx(whole.rows()) - small.row.size();
        ASSERT_EQ(small.column.size() + small.gone.size(), idx(whole.columns()));
        ASSERT_EQ(fewest(small.problem), fewest(whole));
        every_plan(small.problem, [&](const Choice& c) {
            Choice there;
            for (const std::int32_t i : c) there.push_back(small.column[idx(i)]);
            ASSERT_TRUE(is_plan(whole, there));
        });
    }
    EXPECT_GT(gone, 500U);
    EXPECT_GT(rows_gone, 1000U);
}

TEST(Reduce, EachColumnGoesForAReason) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        const Problem whole = random_problem(seed, 14, 10, true);
        const Reduced small = reduce(whole);
        std::vector<std::uint8_t> row(idx(whole.rows()), 0);
        for (const std::int32_t r : small.row) row[idx(r)] = 1;
        std::vector<std::uint8_t> column(idx(whole.columns()), 1);
        const auto holds = [](std::span<const std::int32_t> list, std::int32_t n) {
            return std::find(list.begin(), list.end(), n) != list.end();
        };
        for (const auto& [c, by] : small.gone) {
            ASSERT_EQ(whole.fixed[idx(c)], 0);
            ASSERT_EQ(column[idx(by)], 1);
            for (const std::int32_t r : whole.rows_of.of(c)) {
                ASSERT_TRUE(row[idx(r)] == 0 || holds(whole.rows_of.of(by), r));
            }
            for (const std::int32_t n : whole.near.of(c)) {
                ASSERT_TRUE(n == by || column[idx(n)] == 0 || holds(whole.near.of(by), n));
            }
            column[idx(c)] = 0;
        }
    }
}

TEST(Reduce, RowsAreNeededThatNoOtherStandsFor) {
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        const Problem whole = random_problem(seed, 9, 20, false);
        const auto bits = [&](std::int32_t r) {
            std::uint32_t out = 0;
            for (const std::int32_t c : whole.columns_of.of(r)) out |= std::uint32_t{1} << idx(c);
            return out;
        };
        std::vector<std::int32_t> needed;
        for (std::int32_t r = 0; r < whole.rows(); ++r) {
            bool stands = true;
            for (std::int32_t by = 0; by < whole.rows(); ++by) {
                const bool within = (bits(by) & ~bits(r)) == 0;
                stands = stands && !(within && (bits(by) != bits(r) || by < r));
            }
            if (stands) needed.push_back(r);
        }
        ASSERT_EQ(needed_rows(whole), needed);
    }
}

}  // namespace
}  // namespace vfplan
