// Places that users ask for by coordinates.
#include "kernels/standing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

// A room of 10 x 8 m with a pillar of 2 x 2 m in the middle, and a part where no station may stand.
Site room() {
    Site site;
    const Ring outer = {{0, 0}, {10, 0}, {10, 8}, {0, 8}};
    const Ring pillar = {{4, 3}, {6, 3}, {6, 5}, {4, 5}};
    site.free_border = border_of({outer, pillar});
    for (const Border& b : site.free_border) site.walls.push_back(test::wall(b.a, b.b));
    site.extent = {{0, 0}, {10, 8}};
    return site;
}
const std::vector<Border> carpet = border_of({{{7, 0}, {10, 0}, {10, 2}, {7, 2}}});

TEST(Standing, SaysWhyNot) {
    const Site site = room();
    const Standing standing(site, carpet);
    EXPECT_EQ(standing.objection({2, 2}), "");
    EXPECT_EQ(standing.objection({4, 4}), "it is on a wall");
    EXPECT_EQ(standing.objection({4 - 1e-7, 4}), "it is on a wall");
    EXPECT_EQ(standing.objection({4 - 1e-5, 4}), "");
    EXPECT_EQ(standing.objection({5, 4}), "it is not in free space");
    EXPECT_EQ(standing.objection({11, 4}), "it is outside the site");
    EXPECT_EQ(standing.objection({8, 1}), "plan.forbidden covers it");
}

TEST(Standing, TheNearestPlaceIsLegalAndNear) {
    const Site site = room();
    const Standing standing(site, carpet);
    for (double x = -1; x <= 11; x += 0.317) {
        for (double y = -1; y <= 9; y += 0.291) {
            const Vec2d p(x, y);
            if (standing.objection(p).empty()) continue;
            const auto near = standing.nearest(p);
            ASSERT_TRUE(near) << x << ", " << y;
            EXPECT_EQ(standing.objection(*near), "");
            // The nearest of all places, by a fine comb.
            double best = 1e9;
            for (double u = 0.005; u < 10; u += 0.05) {
                for (double v = 0.005; v < 8; v += 0.05) {
                    if ((Vec2d(u, v) - p).norm() < best && standing.objection({u, v}).empty()) {
                        best = (Vec2d(u, v) - p).norm();
                    }
                }
            }
            EXPECT_LT((*near - p).norm(), best + 0.03) << x << ", " << y;
        }
    }
}

}  // namespace
}  // namespace vfplan
