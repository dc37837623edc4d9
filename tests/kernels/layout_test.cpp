#include "kernels/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

using test::wall;

Layout some_layout(std::int32_t nx, std::int32_t ny, double cell_m, double range_m,
                   std::int64_t tile_cells) {
    Grid grid;
    grid.origin = {-7.25, 3.5};
    grid.cell_m = cell_m;
    grid.nx = nx;
    grid.ny = ny;
    return make_layout(grid, range_m, tile_cells);
}

std::vector<Layout> several() {
    return {some_layout(200, 150, 1, 5, 64),   some_layout(33, 17, 0.5, 4, 256),
            some_layout(1, 1, 2, 100, 64),     some_layout(321, 64, 1, 7, 100),
            some_layout(64, 320, 0.25, 2, 12), some_layout(96, 96, 1, 5.33, 96)};
}

template <class WindowOf, class NumberOf>
void expect_partition(const Grid& grid, std::int64_t n, WindowOf&& window_of,
                      NumberOf&& number_of) {
    std::vector<int> met(static_cast<std::size_t>(grid.size()), 0);
    for (std::int64_t i = 0; i < n; ++i) {
        const Window w = window_of(i);
        ASSERT_GT(w.size(), 0);
        for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
            for (std::int32_t x = w.x_begin; x < w.x_end; ++x) {
                ASSERT_TRUE(grid.inside(x, y));
                ++met[static_cast<std::size_t>(grid.id(x, y))];
                ASSERT_EQ(number_of(grid.id(x, y)), i);
            }
        }
    }
    EXPECT_EQ(std::count(met.begin(), met.end(), 1), grid.size());
}

TEST(Layout, EveryCellLiesInOnePatchAndOneTile) {
    for (const Layout& l : several()) {
        expect_partition(
            l.grid, l.patches(), [&](std::int64_t p) { return l.patch_window(p); },
            [&](std::int64_t c) { return l.patch_of(c); });
        expect_partition(
            l.grid, l.tiles(), [&](std::int64_t t) { return l.tile_window(t); },
            [&](std::int64_t c) { return l.tile_of(c); });
    }
}

TEST(Layout, PatchesAreSixRangesWideAndDoNotDependOnTiles) {
    const Layout a = some_layout(4000, 3000, 0.5, 40, 256);
    EXPECT_EQ(a.patch_cells, 480);
    EXPECT_EQ(a.patch_cells % 32, 0);
    EXPECT_EQ(some_layout(4000, 3000, 0.5, 40, 1000).patch_cells, a.patch_cells);
    EXPECT_EQ(some_layout(4000, 3000, 0.5, 40.1, 256).patch_cells, 512);  // rounded up
    EXPECT_EQ(some_layout(90, 70, 0.5, 1000, 256).patch_cells, 96);       // no larger than the grid
    EXPECT_EQ(some_layout(4000, 3000, 0.5, 0.1, 256).patch_cells, 32);    // nor less than a step
}

TEST(Layout, WindowsMeetThePatchesAndTilesOfTheirCells) {
    std::mt19937_64 random(1);
    for (const Layout& l : several()) {
        for (int i = 0; i < 30; ++i) {
            const auto below = [&](std::int32_t n) {
                return static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(n));
            };
            const std::int32_t x0 = below(l.grid.nx);
            const std::int32_t y0 = below(l.grid.ny);
            const Window w{x0, y0, x0 + 1 + below(l.grid.nx - x0), y0 + 1 + below(l.grid.ny - y0)};
            std::vector<std::int64_t> patches;
            std::vector<std::int64_t> tiles;
            for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
                for (std::int32_t x = w.x_begin; x < w.x_end; ++x) {
                    patches.push_back(l.patch_of(l.grid.id(x, y)));
                    tiles.push_back(l.tile_of(l.grid.id(x, y)));
                }
            }
            for (auto* v : {&patches, &tiles}) {
                std::sort(v->begin(), v->end());
                v->erase(std::unique(v->begin(), v->end()), v->end());
            }
            EXPECT_EQ(l.patches_in(w), patches);
            EXPECT_EQ(l.tiles_in(w), tiles);
        }
    }
}

TEST(Layout, PointsLieInTheCellAroundThem) {
    for (const Layout& l : several()) {
        for (const std::int64_t c : {std::int64_t{0}, l.grid.size() / 2, l.grid.size() - 1}) {
            const Vec2d centre = l.grid.centre(c);
            for (const double dx : {-0.49, 0.0, 0.49}) {
                EXPECT_EQ(l.cell_at(centre + dx * l.grid.cell_m * Vec2d(1, -1)), c);
            }
        }
        // Beyond the grid the nearest cell.
        EXPECT_EQ(l.cell_at(l.grid.origin - Vec2d(50, 60)), 0);
        const Vec2d far = l.grid.origin + l.grid.cell_m * Vec2d(l.grid.nx + 9, l.grid.ny + 9);
        EXPECT_EQ(l.cell_at(far), l.grid.size() - 1);
    }
}

TEST(Layout, PatchOriginIsItsCornerInTheSite) {
    for (const Layout& l : several()) {
        for (std::int64_t p = 0; p < l.patches(); ++p) {
            const Window w = l.patch_window(p);
            const Vec2d first = l.grid.centre(l.grid.id(w.x_begin, w.y_begin));
            EXPECT_NEAR((first - l.patch_origin(p)).x(), l.grid.cell_m / 2, 1e-9);
            EXPECT_NEAR((first - l.patch_origin(p)).y(), l.grid.cell_m / 2, 1e-9);
        }
    }
}

double distance_to_patch(const Layout& l, std::int64_t patch, const Vec2d& p) {
    const Window w = l.patch_window(patch);
    const Vec2d lo = l.patch_origin(patch);
    const Vec2d hi = lo + l.grid.cell_m * Vec2d(w.x_end - w.x_begin, w.y_end - w.y_begin);
    return (p - p.cwiseMax(lo).cwiseMin(hi)).norm();
}

// Walls short and long, some far beyond the grid.
TEST(Layout, NearWallsMissesNoneWithinReach) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> place(-60, 260);
    std::uniform_real_distribution<double> step(-12, 12);
    for (const Layout& l : several()) {
        std::vector<Wall> walls;
        for (int i = 0; i < 200; ++i) {
            const Vec2d a(place(random), place(random));
            walls.push_back(i % 10 == 0 ? wall(a, {place(random), place(random)})
                                        : wall(a, a + Vec2d(step(random), step(random))));
        }
        for (const double reach : {0.0, 5.0, 31.0}) {
            const NearWalls near = near_walls(l, walls, reach);
            ASSERT_EQ(near.begin.size(), static_cast<std::size_t>(l.patches()) + 1);
            for (std::int64_t p = 0; p < l.patches(); ++p) {
                const auto i = static_cast<std::size_t>(p);
                const std::vector<std::int32_t> of(near.wall.begin() + near.begin[i],
                                                   near.wall.begin() + near.begin[i + 1]);
                EXPECT_TRUE(std::is_sorted(of.begin(), of.end()));
                EXPECT_EQ(std::adjacent_find(of.begin(), of.end()), of.end());
                for (std::size_t w = 0; w < walls.size(); ++w) {
                    bool within = false;
                    for (int k = 0; k <= 400; ++k) {
                        const Vec2d at = walls[w].a + (walls[w].b - walls[w].a) * k / 400;
                        within = within || distance_to_patch(l, p, at) < reach - 1e-9;
                    }
                    if (!within) continue;
                    EXPECT_TRUE(
                        std::binary_search(of.begin(), of.end(), static_cast<std::int32_t>(w)))
                        << "patch " << p << ", wall " << w;
                }
            }
        }
    }
}

// What lies within reach of no patch's box is kept away from it: scenes stay small.
TEST(Layout, NearWallsTakesNoneBeyondReach) {
    const Layout l = some_layout(400, 400, 1, 5, 64);
    const NearWalls near = near_walls(l, {wall({60, 60}, {62, 61})}, 5);
    EXPECT_LE(near.wall.size(), 4U);
    EXPECT_GE(near.wall.size(), 1U);
}

}  // namespace
}  // namespace vfplan
