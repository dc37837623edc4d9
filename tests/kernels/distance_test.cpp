#include "kernels/distance.h"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/kernels/raster_art.h"

namespace vfplan {
namespace {

using test::Picture;

// Looks at every outside cell and at the frame just beyond the grid.
void expect_brute_force(const Picture& p, const DistanceField& d) {
    for (std::int32_t y = 0; y < p.grid.ny; ++y) {
        for (std::int32_t x = 0; x < p.grid.nx; ++x) {
            const auto i = static_cast<std::size_t>(p.grid.id(x, y));
            std::tuple best{1 << 30, 0, 0};  // squared distance, column, row
            for (std::int32_t v = -1; v <= p.grid.ny; ++v) {
                for (std::int32_t u = -1; u <= p.grid.nx; ++u) {
                    if (p.has(u, v)) continue;
                    best = std::min(best, std::tuple((u - x) * (u - x) + (v - y) * (v - y), u, v));
                }
            }
            const auto [squared, u, v] = best;
            ASSERT_EQ(d.squared[i], squared) << "cell " << x << ", " << y;
            ASSERT_EQ(d.nearest_dx[i], u - x) << "cell " << x << ", " << y;
            ASSERT_EQ(d.nearest_dy[i], v - y) << "cell " << x << ", " << y;
        }
    }
}

TEST(Distance, EqualsBruteForceOnRandomDomains) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 60; ++i) {
        const Picture p = test::random_domain(random, 5 + i % 27, 4 + i % 19);
        expect_brute_force(p, test::distance_of(p));
    }
}

TEST(Distance, FewOutsideCellsMakeManyTies) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 40; ++i) {
        Picture p = test::blank(24, 21, 1);
        for (int k = 0; k < i % 5; ++k) {
            p.at(static_cast<std::int32_t>(random() % 24),
                 static_cast<std::int32_t>(random() % 21)) = 0;
        }
        expect_brute_force(p, test::distance_of(p));
    }
}

TEST(Distance, FullEmptyAndThinDomains) {
    for (const auto& [nx, ny] :
         {std::pair(1, 1), std::pair(1, 9), std::pair(9, 1), std::pair(8, 8)}) {
        for (const std::uint8_t value : {std::uint8_t{0}, std::uint8_t{1}}) {
            const Picture p = test::blank(nx, ny, value);
            expect_brute_force(p, test::distance_of(p));
        }
    }
}

TEST(Distance, PartsOfAGridGiveTheWhole) {
    std::mt19937_64 random(3);
    const Picture p = test::random_domain(random, 31, 23);
    const DistanceField whole = test::distance_of(p);
    DistanceField parts;
    parts.resize(p.grid.size());
    for (const auto& [from, to] : {std::pair(20, 31), std::pair(0, 7), std::pair(7, 20)}) {
        distance_columns(p.grid, p.set, from, to, parts);
    }
    for (const auto& [from, to] : {std::pair(11, 23), std::pair(0, 11)}) {
        distance_rows(p.grid, p.set, from, to, parts);
    }
    EXPECT_EQ(parts.squared, whole.squared);
    EXPECT_EQ(parts.nearest_dx, whole.nearest_dx);
    EXPECT_EQ(parts.nearest_dy, whole.nearest_dy);
}

}  // namespace
}  // namespace vfplan
