#include "kernels/free_cells.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>

#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

using test::wall;

TEST(FreeCells, GridCoversTheExtentAndNoMore) {
    for (const double cell : {0.1, 0.25, 1.0, 2.0, 3.7}) {
        for (const Box& box : {Box{{0, 0}, {10, 4}}, Box{{-3, 12.5}, {17.3, 12.9}}}) {
            const Grid g = make_grid(box, cell, 0.001);
            EXPECT_EQ(g.cell_m, cell);
            const Vec2d end = g.origin + cell * Vec2d(g.nx, g.ny);
            for (const int k : {0, 1}) {
                EXPECT_LE(g.origin[k], box.min[k]);
                EXPECT_GE(g.origin[k], box.min[k] - 0.001);
                EXPECT_GE(end[k], box.max[k] - 1e-6);
                EXPECT_LT(end[k] - cell, box.max[k]);
            }
        }
    }
}

TEST(FreeCells, NoCentreLiesOnAMultipleOfTheSnap) {
    for (const double cell : {0.1, 0.25, 0.5, 1.0, 2.0, 2.5}) {
        const Grid g = make_grid({{3, 7}, {13, 17}}, cell, 0.001);
        for (std::int32_t i = 0; i < g.nx; ++i) {
            const double snaps = g.centre(g.id(i, 0)).x() / 0.001;
            EXPECT_GT(std::abs(snaps - std::round(snaps)), 0.2) << cell;
        }
    }
}

TEST(FreeCells, CellNumbersRunRowByRow) {
    Grid g;
    g.origin = {10, 20};
    g.cell_m = 2;
    g.nx = 5;
    g.ny = 3;
    EXPECT_EQ(g.size(), 15);
    EXPECT_EQ(g.id(3, 2), 13);
    EXPECT_EQ(g.ix(13), 3);
    EXPECT_EQ(g.iy(13), 2);
    EXPECT_EQ(g.centre(13), Vec2d(17, 25));
    EXPECT_TRUE(g.inside(4, 2));
    EXPECT_FALSE(g.inside(5, 0));
    EXPECT_FALSE(g.inside(0, -1));
}

// Counts the ring edges that a ray to the east crosses.
bool surrounded_oddly(const std::vector<Ring>& rings, const Vec2d& p) {
    bool odd = false;
    for (const Ring& ring : rings) {
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Vec2d& a = ring[i];
            const Vec2d& b = ring[(i + 1) % ring.size()];
            if ((a.y() > p.y()) == (b.y() > p.y())) continue;
            const double x = a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
            if (x > p.x()) odd = !odd;
        }
    }
    return odd;
}

TEST(FreeCells, FreeIsInsideAnOddNumberOfRings) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(-6, 36);  // rings reach beyond the grid
    std::int64_t free = 0;
    for (int i = 0; i < 50; ++i) {
        std::vector<Ring> rings(1 + random() % 4);
        for (Ring& ring : rings) {
            ring.resize(3 + random() % 6);
            for (Vec2d& p : ring) p = {place(random), place(random)};
        }
        const Grid g = make_grid({{0, 0}, {30, 25}}, 1, 0.001);
        const auto cells = free_cells(g, border_of(rings));
        for (std::int64_t c = 0; c < g.size(); ++c) {
            ASSERT_EQ(cells[static_cast<std::size_t>(c)],
                      surrounded_oddly(rings, g.centre(c)) ? 1 : 0);
            free += cells[static_cast<std::size_t>(c)];
        }
    }
    EXPECT_GT(free, 1000);
}

TEST(FreeCells, CornersAtTheHeightOfCentresCountOnce) {
    Grid g;
    g.nx = g.ny = 9;
    const Ring diamond = {{4.4, 0.5}, {8.4, 4.5}, {4.4, 8.5}, {0.4, 4.5}};
    const auto cells = free_cells(g, border_of({diamond}));
    for (std::int32_t x = 0; x < 9; ++x) {
        EXPECT_EQ(cells[static_cast<std::size_t>(g.id(x, 4))], x < 8 ? 1 : 0) << x;
        EXPECT_EQ(cells[static_cast<std::size_t>(g.id(x, 2))], x >= 2 && x < 6 ? 1 : 0) << x;
    }
}

TEST(FreeCells, HoleIsNotFree) {
    const Grid g = make_grid({{0, 0}, {10, 10}}, 1, 0.001);
    const Ring outer = {{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    const Ring hole = {{4, 4}, {6, 4}, {6, 6}, {4, 6}};
    const auto cells = free_cells(g, border_of({outer, hole}));
    EXPECT_EQ(std::count(cells.begin(), cells.end(), 1), 100 - 4);
    EXPECT_EQ(cells[static_cast<std::size_t>(g.id(5, 5))], 0);
}

TEST(CellsOnWalls, AreThoseWhoseCentreIsOnOne) {
    std::mt19937_64 random(3);
    std::int64_t on_some = 0;
    for (int round = 0; round < 300; ++round) {
        const auto below = [&](int n) {
            return static_cast<double>(random() % static_cast<unsigned>(n));
        };
        Grid g;
        g.origin = {below(5) - 2, 0.5};
        g.cell_m = 0.5;
        g.nx = 20;
        g.ny = 17;
        std::vector<Wall> walls(5);
        for (Wall& w : walls) {  // corners on centres and between them
            w.a = g.origin + Vec2d(0.25 * below(44) - 0.5, 0.25 * below(40) - 0.5);
            do {
                w.b = g.origin + Vec2d(0.25 * below(44) - 0.5, 0.25 * below(40) - 0.5);
            } while (w.b == w.a);
        }
        const auto on = cells_on_walls(g, walls);
        for (std::int64_t c = 0; c < g.size(); ++c) {
            bool want = false;
            for (const Wall& w : walls) {
                const Vec2d e = w.b - w.a;
                const double t = std::clamp((g.centre(c) - w.a).dot(e) / e.squaredNorm(), 0.0, 1.0);
                want = want || (w.a + t * e - g.centre(c)).norm() < 1e-9;
            }
            ASSERT_EQ(on[static_cast<std::size_t>(c)] != 0, want)
                << "round " << round << ", cell " << c;
            on_some += want ? 1 : 0;
        }
    }
    EXPECT_GT(on_some, 1000);
}

bool segments_cross(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
    const double u = orient(a, b, c) * orient(a, b, d);
    const double v = orient(c, d, a) * orient(c, d, b);
    return u <= 0 && v <= 0;
}

TEST(ClosedLinks, EqualBruteForceOnRandomWalls) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> place(-3, 28);
    std::int64_t closed_in_all = 0;
    for (int i = 0; i < 40; ++i) {
        const Grid g = make_grid({{0, 0}, {25, 20}}, i % 2 == 0 ? 1 : 2.5, 0.001);
        Raster<std::uint8_t> free(static_cast<std::size_t>(g.size()));
        for (auto& cell : free) cell = random() % 8 != 0;
        std::vector<Wall> walls;
        for (int k = 0; k < 6; ++k) {
            walls.push_back(wall({place(random), place(random)}, {place(random), place(random)}));
        }
        walls.push_back(wall({3, 4}, {3, 9}));
        walls.push_back(wall({5, 6}, {12, 6}));
        const auto closed = closed_steps(g, free, walls, {0, 0, g.nx, g.ny});
        for (std::int64_t c = 0; c < g.size(); ++c) {
            for (unsigned k = 0; k < 8; ++k) {
                const std::int32_t x = g.ix(c) + around_dx[k];
                const std::int32_t y = g.iy(c) + around_dy[k];
                bool want = false;
                if (g.inside(x, y) && free[static_cast<std::size_t>(c)] != 0 &&
                    free[static_cast<std::size_t>(g.id(x, y))] != 0) {
                    for (const Wall& w : walls) {
                        want = want || segments_cross(w.a, w.b, g.centre(c), g.centre(g.id(x, y)));
                    }
                }
                ASSERT_EQ(closed[static_cast<std::size_t>(c)] >> k & 1U, want ? 1U : 0U)
                    << "cell " << g.ix(c) << ", " << g.iy(c) << ", neighbour " << k;
                closed_in_all += want ? 1 : 0;
            }
        }
    }
    EXPECT_GT(closed_in_all, 1000);
}

TEST(ClosedLinks, ThinWallPartsItsTwoSides) {
    const Grid g = make_grid({{0, 0}, {8, 6}}, 1, 0.001);
    const Raster<std::uint8_t> free(static_cast<std::size_t>(g.size()), 1);
    const auto closed = closed_steps(g, free, {wall({4, -1}, {4, 8})}, {0, 0, g.nx, g.ny});
    for (std::int64_t c = 0; c < g.size(); ++c) {
        for (unsigned k = 0; k < 8; ++k) {
            const std::int32_t x = g.ix(c) + around_dx[k];
            const bool inside = g.inside(x, g.iy(c) + around_dy[k]);
            const bool across = inside && (g.ix(c) < 4) != (x < 4);
            EXPECT_EQ(closed[static_cast<std::size_t>(c)] >> k & 1U, across ? 1U : 0U);
        }
    }
}

// Owners cut into windows: together the links of the whole, each of them noted at both its ends by
// the one window that owns it.
TEST(ClosedLinks, WindowsOfOwnersAddUpToTheWhole) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> place(-3, 28);
    for (int i = 0; i < 20; ++i) {
        const Grid g = make_grid({{0, 0}, {25, 20}}, 1, 0.001);
        Raster<std::uint8_t> free(static_cast<std::size_t>(g.size()));
        for (auto& cell : free) cell = random() % 8 != 0;
        std::vector<Wall> walls;
        for (int k = 0; k < 8; ++k) {
            walls.push_back(wall({place(random), place(random)}, {place(random), place(random)}));
        }
        const auto whole = closed_steps(g, free, walls, {0, 0, g.nx, g.ny});
        Raster<std::uint8_t> sum(whole.size(), 0);
        std::int64_t bits = 0;
        for (std::int32_t y = 0; y < g.ny; y += 6) {
            for (std::int32_t x = 0; x < g.nx; x += 9) {
                const Window owners{x, y, std::min(x + 9, g.nx), std::min(y + 6, g.ny)};
                const auto part = closed_steps(g, free, walls, owners);
                for (std::size_t c = 0; c < sum.size(); ++c) {
                    EXPECT_EQ(sum[c] & part[c], 0) << "noted twice";
                    sum[c] = static_cast<std::uint8_t>(sum[c] | part[c]);
                    bits += std::popcount(part[c]);
                }
            }
        }
        EXPECT_EQ(sum, whole);
        EXPECT_GT(bits, 50);
    }
}

TEST(FreeCells, NeighboursRunCounterClockwiseFromEast) {
    for (int k = 0; k < 8; ++k) {
        const double angle = k * pi / 4;
        EXPECT_EQ(around_dx[k], std::lround(std::cos(angle) * 1.1));
        EXPECT_EQ(around_dy[k], std::lround(std::sin(angle) * 1.1));
    }
}

TEST(CellsNearWalls, AreThoseWithinTheClearance) {
    Grid g;
    g.cell_m = 0.1;
    g.nx = 40;
    g.ny = 30;
    Wall wall;
    wall.a = {1, 1};
    wall.b = {3, 2};
    for (const double clearance : {0.0, 0.05, 0.4, 5.0}) {
        const auto near = cells_near_walls(g, {wall}, clearance);
        for (std::int64_t c = 0; c < g.size(); ++c) {
            const Vec2d p = g.centre(c) - wall.a;
            const Vec2d e = wall.b - wall.a;
            const double t = std::min(1.0, std::max(0.0, p.dot(e) / e.dot(e)));
            EXPECT_EQ(near[static_cast<std::size_t>(c)] != 0, (p - t * e).norm() < clearance)
                << c << " at " << clearance;
        }
    }
}

}  // namespace
}  // namespace vfplan
