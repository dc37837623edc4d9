// Squares of a site: all its walls are in them, and those with much wall are likelier to be tried.
#include "engine/job/squares.h"

#include <gtest/gtest.h>

#include <numeric>

#include "engine/job/outlook.h"
#include "tests/io/site/features.h"
#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

using test::add_ring;
using test::box_ring;

// Houses of 10 m on a lattice of 30 m, as seen from outside, and one far off.
Site houses(int columns, int rows, double stray_m = 0) {
    Site site;
    const auto add = [&](double x, double y) {
        const std::size_t first = site.walls.size();
        add_ring(site.walls, box_ring(x, y, x + 10, y + 10));
        for (std::size_t i = first; i < site.walls.size(); ++i) {
            site.walls[i].free_side[left] = false;
        }
    };
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) add(30 * x, 30 * y);
    }
    if (stray_m > 0) add(stray_m, stray_m);
    for (const Wall& w : site.walls) site.free_border.push_back({w.a, w.b});
    site.extent = test::bounds_of(site.walls);
    return site;
}

double sum(const std::vector<Squares::Taken>& taken) {
    return std::accumulate(taken.begin(), taken.end(), 0.0,
                           [](double s, const Squares::Taken& t) { return s + t.times; });
}

TEST(SquaresOfASite, HoldAllFacesAndAreHitByTheirShare) {
    const Site site = houses(20, 20, 5000);
    const Squares squares(site, 200);
    EXPECT_DOUBLE_EQ(squares.all_walls_m(), 401 * 40.0);
    for (const int n : {1, 6, 100}) EXPECT_EQ(sum(squares.by_walls(n)), n);
    for (const auto& t : squares.by_walls(6)) {
        EXPECT_LE(squares.box(t.square).max.x(), 800) << "the one far off has 1/401 of all";
    }
    EXPECT_LT(squares.share_with_walls(), 0.05);
    const auto empty = squares.without_walls(2);
    ASSERT_EQ(empty.size(), 2U);
    for (const auto& t : empty) EXPECT_EQ(squares.walls_m(t.square), 0);
}

TEST(SquaresOfASite, WhatNeedNotBeScannedDoesNotCount) {
    Site site = houses(3, 3);
    site.walls.push_back(test::wall({0, 75}, {1e5, 75}));
    site.walls.back().scanned = false;
    site.extent = test::bounds_of(site.walls);
    EXPECT_DOUBLE_EQ(Squares(site, 200).all_walls_m(), 9 * 40.0);
}

TEST(SquaresOfASite, APartHasTheWallsInReachButNotTooMany) {
    const Site site = houses(20, 20);
    const Box box{{200, 200}, {300, 300}};
    const auto near = part_of_site(site, box, 50, 100000).walls.size();
    EXPECT_EQ(near, 7U * 7U * 4U);
    EXPECT_EQ(part_of_site(site, box, 1e4, 100000).walls.size(), site.walls.size());
    EXPECT_LE(part_of_site(site, box, 1e4, 200).walls.size(), 200U);
    EXPECT_EQ(part_of_site(site, box, 50, 100000).extent.max, box.max);
}

TEST(Outlook, OneSeesAsFarAsTheStreetsAreWideNotAsTheRange) {
    const Threads threads(1);
    const Outlook town = look_around(houses(20, 20), 5000, threads);
    EXPECT_GT(town.sight_m, 15);
    EXPECT_LT(town.sight_m, 2000);
    EXPECT_GT(town.spans, 5);
    Site room;
    add_ring(room.walls, box_ring(0, 0, 6, 4));
    for (Wall& w : room.walls) w.free_side[right] = false;
    room.extent = test::bounds_of(room.walls);
    const Outlook in_room = look_around(room, 30, threads);
    EXPECT_GT(in_room.sight_m, 2);
    EXPECT_LT(in_room.sight_m, 7.3);
    EXPECT_NEAR(look_around(houses(1, 1), 30, threads).sight_m, 30, 1e-9)
        << "nothing else in sight";
}

}  // namespace
}  // namespace vfplan
