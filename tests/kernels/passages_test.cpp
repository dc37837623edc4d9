#include "kernels/passages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "kernels/free_cells.h"
#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

// Two rooms of 4 x 4 m and a neck between them, turned, and where one may stand in them.
struct Dumbbell {
    static constexpr double clearance_m = 0.4;
    double turn = 0;
    std::vector<Wall> walls;
    Grid grid;
    Raster<std::uint8_t> free, near, passage;

    Dumbbell(double width_m, double depth_m, double turn_by, double cell_m,
             std::vector<Wall> more = {})
        : turn(turn_by) {
        const double low = 2 - width_m / 2;
        const double high = 2 + width_m / 2;
        const double second = 4 + depth_m;
        const Ring ring = {{0, 0},         {4, 0},          {4, low},        {second, low},
                           {second, 0},    {second + 4, 0}, {second + 4, 4}, {second, 4},
                           {second, high}, {4, high},       {4, 4},          {0, 4}};
        test::add_ring(walls, ring);
        walls.insert(walls.end(), more.begin(), more.end());
        for (Wall& w : walls) w = test::wall(turned(w.a), turned(w.b));
        Ring border;
        for (const Vec2d& v : ring) border.push_back(turned(v));
        Box box = test::bounds_of(walls);
        box.min -= Vec2d(1, 1);
        box.max += Vec2d(1, 1);
        grid = make_grid(box, cell_m, 0.001);
        free = free_cells(grid, border_of({border}));
        near = cells_near_walls(grid, walls, clearance_m);
        passage = cells_in_passages(grid, free, near, walls, clearance_m);
    }
    Vec2d turned(const Vec2d& v) const {
        return {std::cos(turn) * v.x() - std::sin(turn) * v.y(),
                std::sin(turn) * v.x() + std::cos(turn) * v.y()};
    }
    bool standable(std::int64_t c) const {
        const auto i = static_cast<std::size_t>(c);
        return free[i] != 0 && (near[i] == 0 || passage[i] != 0);
    }
    std::int64_t passages() const { return std::count(passage.begin(), passage.end(), 1); }
    // True where one gets from the middle of one room to that of the other over standable cells.
    bool joined(double depth_m) const {
        const auto cell_at = [&](const Vec2d& v) {
            const Vec2d p = (turned(v) - grid.origin) / grid.cell_m;
            return grid.id(static_cast<std::int32_t>(p.x()), static_cast<std::int32_t>(p.y()));
        };
        std::vector<std::uint8_t> seen(free.size(), 0);
        std::vector<std::int64_t> open = {cell_at({2, 2})};
        seen[static_cast<std::size_t>(open[0])] = 1;
        while (!open.empty()) {
            const std::int64_t c = open.back();
            open.pop_back();
            for (int k = 0; k < 8; ++k) {
                const std::int64_t n =
                    grid.id(grid.ix(c) + around_dx[k], grid.iy(c) + around_dy[k]);
                if (!standable(n) || seen[static_cast<std::size_t>(n)] != 0) continue;
                seen[static_cast<std::size_t>(n)] = 1;
                open.push_back(n);
            }
        }
        return seen[static_cast<std::size_t>(cell_at({6 + depth_m, 2}))] != 0;
    }
};

TEST(Passages, DoorwaysLeadFromRoomToRoom) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> turn(0, 2 * pi);
    for (const double width : {0.45, 0.6, 0.7, 0.79}) {
        for (const double depth : {0.05, 0.2, 0.4}) {
            for (const double cell : {0.02, 0.05}) {
                for (int k = 0; k < 4; ++k) {
                    const double by = k == 0 ? 0 : turn(random);
                    const Dumbbell d(width, depth, by, cell);
                    // What is left between the jambs is too narrow without.
                    EXPECT_TRUE(d.joined(depth))
                        << width << " wide, " << depth << " deep, cells of " << cell
                        << ", turned by " << by;
                }
            }
        }
    }
}

TEST(Passages, AreInTheMiddle) {
    for (const double turn : {0.0, 0.3, 1.1}) {
        const Dumbbell d(0.6, 0.3, turn, 0.02);
        ASSERT_GT(d.passages(), 15);
        for (std::int64_t c = 0; c < d.grid.size(); ++c) {
            if (d.passage[static_cast<std::size_t>(c)] == 0) continue;
            const Vec2d p = d.grid.centre(c);
            // Turned back: near the axis of the neck.
            const double y = -std::sin(turn) * p.x() + std::cos(turn) * p.y();
            EXPECT_LT(std::abs(y - 2), 0.03);
        }
    }
}

TEST(Passages, NarrowerThanTheClearanceIsNone) {
    EXPECT_EQ(Dumbbell(0.38, 0.2, 0, 0.02).passages(), 0);
    EXPECT_FALSE(Dumbbell(0.38, 0.2, 0, 0.02).joined(0.2));
}

TEST(Passages, LongNecksAreNoDoorways) {
    // Its ends see one room only.
    const Dumbbell d(0.6, 3, 0, 0.02);
    EXPECT_EQ(d.passages(), 0);
    EXPECT_FALSE(d.joined(3));
}

TEST(Passages, AClosedDoorIsNoPassage) {
    const std::vector<Wall> door = {test::wall({4.1, 1.7}, {4.1, 2.3})};
    const Dumbbell d(0.6, 0.2, 0, 0.02, door);
    EXPECT_EQ(d.passages(), 0);
    EXPECT_FALSE(d.joined(0.2));
}

TEST(Passages, CornersAndNichesAreNone) {
    // A room with a niche 0.6 m wide and 1 m deep; its four corners are too near to walls as well.
    std::vector<Wall> walls;
    const Ring ring = {{0, 0}, {4, 0}, {4, 1.7}, {5, 1.7}, {5, 2.3}, {4, 2.3}, {4, 4}, {0, 4}};
    test::add_ring(walls, ring);
    const Grid grid = make_grid({{-1, -1}, {6, 5}}, 0.02, 0.001);
    const auto free = free_cells(grid, border_of({ring}));
    const auto near = cells_near_walls(grid, walls, 0.4);
    const auto passage = cells_in_passages(grid, free, near, walls, 0.4);
    EXPECT_EQ(std::count(passage.begin(), passage.end(), 1), 0);
}

TEST(Passages, APillarIsPassedOnEitherSide) {
    std::vector<Wall> walls;
    const Ring room = {{0, 0}, {6, 0}, {6, 2}, {0, 2}};
    const Ring pillar = {{2.9, 0.6}, {3.1, 0.6}, {3.1, 1.4}, {2.9, 1.4}};
    test::add_ring(walls, room);
    test::add_ring(walls, pillar);
    const Grid grid = make_grid({{-1, -1}, {7, 3}}, 0.02, 0.001);
    const auto free = free_cells(grid, border_of({room, pillar}));
    const auto near = cells_near_walls(grid, walls, 0.4);
    const auto passage = cells_in_passages(grid, free, near, walls, 0.4);
    std::int64_t below = 0;
    std::int64_t above = 0;
    for (std::int64_t c = 0; c < grid.size(); ++c) {
        if (passage[static_cast<std::size_t>(c)] == 0) continue;
        const Vec2d p = grid.centre(c);
        EXPECT_LT(std::abs(p.x() - 3), 0.5);
        (p.y() < 1 ? below : above) += 1;
    }
    EXPECT_GT(below, 10);
    EXPECT_GT(above, 10);
}

}  // namespace
}  // namespace vfplan
