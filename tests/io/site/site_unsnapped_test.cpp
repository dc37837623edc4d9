// Coordinates finer than the snap: whatever the number of buildings, every wall keeps its sides.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "io/site/site_reader.h"

namespace vfplan {
namespace {

// A rectangle (or an L) turned by any angle, at coordinates of full precision.
Feature house(std::mt19937_64& random, double x, double y, bool l_shaped) {
    const auto uniform = [&](double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(random() >> 11) / 9007199254740992.0;
    };
    const double turn = uniform(0, 6.283);
    const double w = uniform(6, 15);
    const double h = uniform(6, 15);
    Ring shape = {{0, 0}, {w, 0}, {w, h}, {0, h}};
    if (l_shaped) shape = {{0, 0}, {w, 0}, {w, h / 2}, {w / 3, h / 2}, {w / 3, h}, {0, h}};
    Polygon p;
    for (const Vec2d& v : shape) {
        p.outer.emplace_back(x + std::cos(turn) * v.x() - std::sin(turn) * v.y(),
                             y + std::sin(turn) * v.x() + std::cos(turn) * v.y());
    }
    Feature f;
    f.polygons = {p};
    return f;
}

double perimeter(const Polygon& p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.outer.size(); ++i) {
        sum += (p.outer[(i + 1) % p.outer.size()] - p.outer[i]).norm();
    }
    return sum;
}

class Unsnapped : public testing::TestWithParam<int> {};

TEST_P(Unsnapped, EveryWallHasOneFreeSide) {
    std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
    for (int trial = 0; trial < 40; ++trial) {
        FeatureSet set;
        double around = 0;
        std::size_t edges = 0;
        for (int k = 0; k < GetParam(); ++k) {
            set.features.push_back(house(random, 389438.1 + 40 * k, 5819047.3, trial % 2 == 1));
            around += perimeter(set.features.back().polygons[0]);
            edges += set.features.back().polygons[0].outer.size();
        }
        const Site site = build_site(set, {}, "houses").site;
        EXPECT_EQ(site.walls.size(), edges) << "trial " << trial;
        double length = 0;
        for (const Wall& w : site.walls) {
            EXPECT_NE(w.free_side[left], w.free_side[right]) << "trial " << trial;
            length += w.length_m();
        }
        EXPECT_NEAR(length, around, 0.002 * static_cast<double>(edges)) << "trial " << trial;
        EXPECT_EQ(site.counts.inside_solids, 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Houses, Unsnapped, testing::Values(1, 2, 3, 6));

}  // namespace
}  // namespace vfplan
