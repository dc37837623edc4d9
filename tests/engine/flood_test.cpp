// Shortest ways over cells.
#include "engine/flood.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/kernels/raster_art.h"

namespace vfplan {
namespace {

using test::draw;
using test::Picture;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

TEST(Flood, StepsOfTenAndFourteenAroundObstacles) {
    const Picture p = draw({"####.",  //
                            "#..#.",  //
                            "###..",  //
                            "....#"});
    const Raster<std::uint8_t> open(p.set.size(), 0);
    Flood flood(p.grid, p.set, open);
    flood.add_source(0, 7);
    flood.run();
    EXPECT_EQ(flood.distance(0), 0);
    EXPECT_EQ(flood.distance(p.grid.id(3, 0)), 30);
    EXPECT_EQ(flood.distance(p.grid.id(3, 1)), 34);  // 10, 10, 14
    EXPECT_EQ(flood.distance(p.grid.id(2, 2)), 34);  // diagonal steps may cut corners of cells
    EXPECT_EQ(flood.source(p.grid.id(2, 2)), 7);
    EXPECT_EQ(flood.distance(p.grid.id(4, 3)), Flood::unreached);
    EXPECT_EQ(flood.source(p.grid.id(4, 3)), -1);
    EXPECT_EQ(flood.distance(p.grid.id(1, 1)), Flood::unreached);  // not free
    EXPECT_EQ(flood.path_to(p.grid.id(2, 2)),
              (std::vector<std::int64_t>{0, 5, 11, 12}));  // (0,0) (0,1) (1,2) (2,2)
    EXPECT_EQ(flood.path_to(0), std::vector<std::int64_t>{0});
}

TEST(Flood, ClosedLinksAreNotCrossed) {
    // A row of five cells; a wall between 1 and 2 seen from either side.
    const Picture p = draw({"#####"});
    for (const int side : {0, 1}) {
        Raster<std::uint8_t> closed(5, 0);
        closed[1] = 1U << 0;
        closed[2] = 1U << 4;
        Flood flood(p.grid, p.set, closed);
        flood.add_source(side == 0 ? 0 : 4, 0);
        flood.run();
        EXPECT_EQ(flood.distance(side == 0 ? 1 : 2), side == 0 ? 10 : 20);
        EXPECT_EQ(flood.distance(side == 0 ? 2 : 1), Flood::unreached);
    }
}

TEST(Flood, TiesFallToTheSmallerCellAndTheFirstName) {
    const Picture p = draw({"#####"});
    const Raster<std::uint8_t> open(5, 0);
    Flood flood(p.grid, p.set, open);
    flood.add_source(4, 1);
    flood.add_source(0, 2);
    flood.add_source(0, 3);
    flood.run();
    EXPECT_EQ(flood.source(0), 2);
    EXPECT_EQ(flood.source(2), 2);  // as far from both: from cell 1, not from cell 3
    EXPECT_EQ(flood.path_to(2), (std::vector<std::int64_t>{0, 1, 2}));
    EXPECT_EQ(flood.source(3), 1);
}

TEST(Flood, EqualsRelaxingUntilNothingChanges) {
    std::mt19937_64 random(9);
    for (int round = 0; round < 20; ++round) {
        const Picture p = test::random_domain(random, 23, 17);
        Raster<std::uint8_t> closed(p.set.size(), 0);
        for (std::int64_t c = 0; c < p.grid.size(); ++c) {
            for (std::size_t k = 0; k < 4; ++k) {
                const std::int32_t x = p.grid.ix(c) + around_dx[k];
                const std::int32_t y = p.grid.iy(c) + around_dy[k];
                if (!p.grid.inside(x, y) || random() % 6 != 0) continue;
                closed[at(c)] = static_cast<std::uint8_t>(closed[at(c)] | 1U << k);
                auto& other = closed[at(p.grid.id(x, y))];
                other = static_cast<std::uint8_t>(other | 1U << (k + 4));
            }
        }
        Flood flood(p.grid, p.set, closed);
        std::vector<std::int64_t> far(p.set.size(), Flood::unreached);
        for (int s = 0; s < 3; ++s) {
            const auto c = static_cast<std::int64_t>(random() % p.set.size());
            if (p.set[at(c)] == 0) continue;
            flood.add_source(c, s);
            far[at(c)] = 0;
        }
        flood.run();
        const auto steps = [&](std::int64_t c, auto&& f) {
            for (std::size_t k = 0; k < 8; ++k) {
                const std::int32_t x = p.grid.ix(c) + around_dx[k];
                const std::int32_t y = p.grid.iy(c) + around_dy[k];
                if (!p.has(x, y) || (closed[at(c)] >> k & 1U) != 0) continue;
                f(p.grid.id(x, y), k % 2 == 0 ? 10 : 14);
            }
        };
        for (bool changed = true; changed;) {
            changed = false;
            for (std::int64_t c = 0; c < p.grid.size(); ++c) {
                if (far[at(c)] == Flood::unreached) continue;
                steps(c, [&](std::int64_t n, int d) {
                    if (far[at(c)] + d >= far[at(n)]) return;
                    far[at(n)] = far[at(c)] + d;
                    changed = true;
                });
            }
        }
        for (std::int64_t c = 0; c < p.grid.size(); ++c) {
            ASSERT_EQ(flood.distance(c), far[at(c)]);
            if (far[at(c)] == Flood::unreached) continue;
            const auto path = flood.path_to(c);
            int length = 0;
            for (std::size_t i = 0; i + 1 < path.size(); ++i) {
                int step = 0;
                steps(path[i], [&](std::int64_t n, int d) { step = n == path[i + 1] ? d : step; });
                ASSERT_GT(step, 0);
                length += step;
            }
            EXPECT_EQ(length, far[at(c)]);
            EXPECT_EQ(flood.source(c), flood.source(path.front()));
        }
    }
}

}  // namespace
}  // namespace vfplan
