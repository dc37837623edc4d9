#include "kernels/skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>

#include "tests/kernels/raster_art.h"

namespace vfplan {
namespace {

using test::blank;
using test::distance_of;
using test::holes;
using test::parts;
using test::Picture;
using test::skeleton_of;

Picture box(std::int32_t nx, std::int32_t ny) {
    Picture p = blank(nx + 4, ny + 4);
    for (std::int32_t y = 2; y < ny + 2; ++y) {
        for (std::int32_t x = 2; x < nx + 2; ++x) p.at(x, y) = 1;
    }
    return p;
}

// Whether a cell may go without changing topology, by counting groups in its 3 x 3 surroundings.
bool removable(const Picture& p, std::int32_t x, std::int32_t y) {
    Picture around = blank(3, 3);
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
        for (std::int32_t dx = -1; dx <= 1; ++dx) around.at(dx + 1, dy + 1) = p.has(x + dx, y + dy);
    }
    around.at(1, 1) = 0;
    if (parts(around) != 1) return false;
    // Background groups that touch the cell by an edge, walking by edges in the eight neighbours.
    constexpr std::array<std::pair<int, int>, 8> ring = {
        {{2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}, {0, 0}, {1, 0}, {2, 0}}};
    std::array<bool, 8> open{};
    for (std::size_t k = 0; k < 8; ++k) open[k] = !around.has(ring[k].first, ring[k].second);
    if (open == std::array<bool, 8>{true, true, true, true, true, true, true, true}) return false;
    int runs = 0;
    for (std::size_t k = 0; k < 8; ++k) {
        if (!open[k] || open[(k + 7) % 8]) continue;
        bool by_edge = false;
        for (std::size_t i = k; open[i % 8]; ++i) by_edge = by_edge || i % 2 == 0;
        runs += by_edge ? 1 : 0;
    }
    return runs == 1;
}

void expect_skeleton(const Picture& domain, const Picture& skeleton) {
    EXPECT_EQ(parts(skeleton), parts(domain));
    EXPECT_EQ(holes(skeleton), holes(domain));
    for (std::int32_t y = 0; y < domain.grid.ny; ++y) {
        for (std::int32_t x = 0; x < domain.grid.nx; ++x) {
            if (!skeleton.has(x, y)) continue;
            EXPECT_TRUE(domain.has(x, y));
            // One cell thin: only ends of lines could still go.
            const unsigned bits = test::neighbourhood(skeleton, skeleton.grid.id(x, y));
            EXPECT_TRUE(!removable(skeleton, x, y) || std::popcount(bits) <= 2)
                << "cell " << x << ", " << y << " is not needed";
        }
    }
}

TEST(Skeleton, KeepsTopologyOnRandomDomains) {
    std::mt19937_64 random(1);
    int most_holes = 0;
    int most_parts = 0;
    for (int i = 0; i < 80; ++i) {
        const Picture domain = test::random_domain(random, 20 + i % 30, 20 + i % 23);
        expect_skeleton(domain, skeleton_of(domain));
        most_holes = std::max(most_holes, holes(domain));
        most_parts = std::max(most_parts, parts(domain));
    }
    EXPECT_GT(most_holes, 5);  // else the domains prove nothing
    EXPECT_GT(most_parts, 5);
}

TEST(Skeleton, KeepsTopologyOfConstructedDomains) {
    Picture ring = box(21, 21);
    for (std::int32_t y = 9; y < 14; ++y) {
        for (std::int32_t x = 9; x < 16; ++x) ring.at(x, y) = 0;
    }
    expect_skeleton(ring, skeleton_of(ring));
    EXPECT_EQ(holes(skeleton_of(ring)), 1);

    Picture speck = blank(5, 5);
    speck.at(2, 2) = 1;
    EXPECT_EQ(skeleton_of(speck).set, speck.set);

    Picture diagonal = blank(9, 9);  // two blocks that touch by a corner are one part
    for (std::int32_t y = 0; y < 4; ++y) {
        for (std::int32_t x = 0; x < 4; ++x) diagonal.at(x, y) = diagonal.at(x + 4, y + 4) = 1;
    }
    expect_skeleton(diagonal, skeleton_of(diagonal));

    const Picture full = blank(15, 11, 1);  // up to the border of the grid
    expect_skeleton(full, skeleton_of(full));
    const Picture nothing = blank(6, 6);
    EXPECT_EQ(skeleton_of(nothing).set, nothing.set);
}

TEST(Skeleton, CorridorGivesItsCentreLine) {
    const Picture s = skeleton_of(box(41, 7));
    for (std::int32_t x = 2 + 4; x < 2 + 37; ++x) {
        for (std::int32_t y = 0; y < s.grid.ny; ++y) {
            EXPECT_EQ(s.has(x, y), y == 2 + 3) << x << ", " << y;
        }
    }
}

TEST(Skeleton, SquareGivesAnX) {
    const std::int32_t n = 21;
    const Picture s = skeleton_of(box(n, n));
    EXPECT_TRUE(s.has(2 + n / 2, 2 + n / 2));
    int arms = 0;
    for (std::int32_t y = 0; y < n; ++y) {
        for (std::int32_t x = 0; x < n; ++x) {
            if (!s.has(2 + x, 2 + y)) continue;
            const std::int32_t off = std::min(std::abs(x - y), std::abs(x + y - (n - 1)));
            EXPECT_LE(off, 1) << x << ", " << y;
        }
    }
    for (const std::int32_t x : {2, n - 3}) {  // into every corner
        for (const std::int32_t y : {2, n - 3}) {
            bool near = false;
            for (std::int32_t d = -2; d <= 2; ++d) near = near || s.has(2 + x, 2 + y + d);
            arms += near ? 1 : 0;
        }
    }
    EXPECT_EQ(arms, 4);
}

TEST(Skeleton, ShallowBendsGrowNoBranches) {
    Picture disc = blank(45, 45);
    for (std::int32_t y = 0; y < 45; ++y) {
        for (std::int32_t x = 0; x < 45; ++x) {
            disc.at(x, y) = (x - 22) * (x - 22) + (y - 22) * (y - 22) <= 400;
        }
    }
    const Picture centre = skeleton_of(disc);
    EXPECT_LE(std::count(centre.set.begin(), centre.set.end(), 1), 9);
    Picture dented = box(41, 11);
    dented.at(22, 2) = 0;  // one cell off a wall
    dented.at(30, 12) = 0;
    const Picture s = skeleton_of(dented);
    for (std::int32_t x = 2 + 7; x < 2 + 34; ++x) {
        int in_column = 0;
        for (std::int32_t y = 0; y < s.grid.ny; ++y) in_column += s.has(x, y) ? 1 : 0;
        EXPECT_EQ(in_column, 1) << x;
    }
}

TEST(Skeleton, DependsOnTheDomainAlone) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 20; ++i) {
        const Picture domain = test::random_domain(random, 26, 24);
        const Picture here = skeleton_of(domain);
        EXPECT_EQ(here.set, skeleton_of(domain).set);
        // The same cells elsewhere in a larger grid, where even columns and rows stay even.
        Picture moved = blank(26 + 11, 24 + 8);
        for (std::int32_t y = 0; y < 24; ++y) {
            for (std::int32_t x = 0; x < 26; ++x) moved.at(x + 8, y + 4) = domain.has(x, y);
        }
        const Picture there = skeleton_of(moved);
        for (std::int32_t y = 0; y < 24; ++y) {
            for (std::int32_t x = 0; x < 26; ++x) {
                EXPECT_EQ(here.has(x, y), there.has(x + 8, y + 4)) << x << ", " << y;
            }
        }
    }
}

TEST(Skeleton, FluxIsStrongOnTheAxisAndWeakBesideIt) {
    const Picture corridor = box(41, 11);
    const DistanceField d = distance_of(corridor);
    EXPECT_LT(outward_flux(corridor.grid, d, corridor.grid.id(22, 7)), -0.4);
    EXPECT_NEAR(outward_flux(corridor.grid, d, corridor.grid.id(22, 4)), 0, 0.05);
}

TEST(Skeleton, NothingIsUnknownOfAWhole) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20; ++i) {
        const Picture domain = test::random_domain(random, 30, 20);
        const auto state = thin(domain.grid, domain.set, distance_of(domain));
        EXPECT_EQ(std::count(state.begin(), state.end(), Cell::unknown), 0);
    }
}

// A window of a domain, as a picture of its own.
Picture part_of_picture(const Picture& p, const Window& w) {
    Picture out = blank(w.x_end - w.x_begin, w.y_end - w.y_begin);
    for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
        for (std::int32_t x = w.x_begin; x < w.x_end; ++x) {
            out.at(x - w.x_begin, y - w.y_begin) = p.has(x, y) ? 1 : 0;
        }
    }
    return out;
}

// Thins a window alone; returns the state of its cells.
std::vector<Cell> thin_part(const Picture& domain, const Window& w) {
    const Picture part = part_of_picture(domain, w);
    return thin(
        part.grid, part.set, distance_of(part),
        {w.x_begin,
         w.y_begin,
         {w.x_begin > 0, w.y_begin > 0, w.x_end < domain.grid.nx, w.y_end < domain.grid.ny}});
}

// What a window's thinning says differently from the whole's, and how much it leaves open within
// `core`.
struct Compared {
    std::int64_t wrong = 0;
    std::int64_t unknown = 0;
    std::int64_t known = 0;
};
Compared compare(const Picture& domain, const Picture& skeleton, const Window& core,
                 const Window& around) {
    const std::vector<Cell> state = thin_part(domain, around);
    Compared out;
    for (std::int32_t y = around.y_begin; y < around.y_end; ++y) {
        for (std::int32_t x = around.x_begin; x < around.x_end; ++x) {
            const Cell s = state[static_cast<std::size_t>(y - around.y_begin) *
                                     static_cast<std::size_t>(around.x_end - around.x_begin) +
                                 static_cast<std::size_t>(x - around.x_begin)];
            if (s == Cell::unknown) {
                out.unknown += core.contains(x, y) ? 1 : 0;
            } else {
                ++out.known;
                out.wrong += (s == Cell::present) != skeleton.has(x, y) ? 1 : 0;
            }
        }
    }
    return out;
}

// Rooms of a street map: large blocks, so that there are long ridges and wide places.
Picture wide_domain(std::mt19937_64& random, std::int32_t nx, std::int32_t ny) {
    Picture p = blank(nx, ny, 1);
    const auto below = [&](std::int32_t n) {
        return static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(n));
    };
    for (int k = 0; k < nx * ny / 250; ++k) {
        const std::int32_t x0 = below(nx);
        const std::int32_t y0 = below(ny);
        const std::int32_t x1 = std::min(nx, x0 + 1 + below(9));
        const std::int32_t y1 = std::min(ny, y0 + 1 + below(9));
        for (std::int32_t y = y0; y < y1; ++y) {
            for (std::int32_t x = x0; x < x1; ++x) p.at(x, y) = 0;
        }
    }
    return p;
}

TEST(Skeleton, AWindowKnowsOnlyWhatIsTrueOfTheWhole) {
    std::mt19937_64 random(4);
    std::int64_t known = 0;
    for (int i = 0; i < 60; ++i) {
        const bool wide = i % 2 == 0;
        const Picture domain = wide ? wide_domain(random, 70 + i % 7, 64 + i % 5)
                                    : test::random_domain(random, 64 + i % 9, 66 + i % 7);
        const Picture skeleton = skeleton_of(domain);
        for (int k = 0; k < 12; ++k) {
            const auto from = [&](std::int32_t n) {
                return static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(n));
            };
            const std::int32_t x0 = k % 3 == 0 ? 0 : from(domain.grid.nx - 8);
            const std::int32_t y0 = k % 4 == 0 ? 0 : from(domain.grid.ny - 8);
            const Window w{x0, y0, k % 5 == 0 ? domain.grid.nx : x0 + 1 + from(domain.grid.nx - x0),
                           k % 2 == 0 ? domain.grid.ny : y0 + 1 + from(domain.grid.ny - y0)};
            const Compared c = compare(domain, skeleton, w, w);
            ASSERT_EQ(c.wrong, 0) << "domain " << i << ", window " << w.x_begin << " " << w.y_begin
                                  << " " << w.x_end << " " << w.y_end;
            known += c.known;
        }
    }
    EXPECT_GT(known, 300000);
}

TEST(Skeleton, UnknownCellsVanishWithAWiderMargin) {
    std::mt19937_64 random(5);
    std::array<std::int64_t, 5> unknown{};
    constexpr std::array<std::int32_t, 5> margins = {0, 6, 12, 24, 48};
    for (int i = 0; i < 12; ++i) {
        const Picture domain = wide_domain(random, 150, 140);
        const Picture skeleton = skeleton_of(domain);
        const Window core{60, 50, 84, 80};
        for (std::size_t m = 0; m < margins.size(); ++m) {
            const Compared c = compare(domain, skeleton, core, core.grown(margins[m], domain.grid));
            EXPECT_EQ(c.wrong, 0);
            unknown[m] += c.unknown;
        }
        // The whole grid as a part of itself leaves nothing open.
        EXPECT_EQ(compare(domain, skeleton, core, {0, 0, 150, 140}).unknown, 0);
    }
    EXPECT_GT(unknown[0], 12 * 24 * 30 / 4);
    for (std::size_t m = 1; m < margins.size(); ++m) EXPECT_LE(unknown[m], unknown[m - 1]);
    EXPECT_EQ(unknown.back(), 0);
}

// Tiles with margins that double until their cores are known are the whole skeleton, cell by cell.
TEST(Skeleton, TilesAddUpToTheWhole) {
    std::mt19937_64 random(6);
    for (int i = 0; i < 8; ++i) {
        const Picture domain =
            i % 2 == 0 ? wide_domain(random, 120, 90) : test::random_domain(random, 120, 90);
        const Picture skeleton = skeleton_of(domain);
        for (const std::int32_t side : {16, 28, 64}) {
            for (std::int32_t y = 0; y < domain.grid.ny; y += side) {
                for (std::int32_t x = 0; x < domain.grid.nx; x += side) {
                    const Window core{x, y, std::min(x + side, domain.grid.nx),
                                      std::min(y + side, domain.grid.ny)};
                    std::int32_t margin = 8;
                    Compared c;
                    do {
                        c = compare(domain, skeleton, core, core.grown(margin, domain.grid));
                        ASSERT_EQ(c.wrong, 0);
                        margin *= 2;
                    } while (c.unknown > 0 && margin < 1000);
                    EXPECT_EQ(c.unknown, 0);
                }
            }
        }
    }
}

}  // namespace
}  // namespace vfplan
