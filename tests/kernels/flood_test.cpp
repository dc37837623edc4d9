// Shortest paths over cells.
#include "kernels/flood.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "kernels/index.h"
#include "tests/kernels/raster_art.h"

namespace vfplan {
namespace {

using test::draw;
using test::Picture;

constexpr std::int32_t far_enough = 1 << 20;

TEST(Flood, StepsOfTenAndFourteenAroundObstacles) {
    const Picture p = draw({"####.",  //
                            "#..#.",  //
                            "###..",  //
                            "....#"});
    const Raster<std::uint8_t> open(p.set.size(), 0);
    Flood flood(p.grid, p.set, open, far_enough);
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
        Flood flood(p.grid, p.set, closed, far_enough);
        flood.add_source(side == 0 ? 0 : 4, 0);
        flood.run();
        EXPECT_EQ(flood.distance(side == 0 ? 1 : 2), side == 0 ? 10 : 20);
        EXPECT_EQ(flood.distance(side == 0 ? 2 : 1), Flood::unreached);
    }
}

TEST(Flood, TiesFallToTheLeastName) {
    const Picture p = draw({"#####"});
    const Raster<std::uint8_t> open(5, 0);
    Flood flood(p.grid, p.set, open, far_enough);
    flood.add_source(4, 1);
    flood.add_source(0, 2);
    flood.add_source(0, 3);
    flood.run();
    EXPECT_EQ(flood.source(0), 2);
    EXPECT_EQ(flood.source(2), 1);  // as far from both: that of the lesser name
    EXPECT_EQ(flood.path_to(2), (std::vector<std::int64_t>{4, 3, 2}));
    EXPECT_EQ(flood.source(1), 2);
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
                closed[idx(c)] = static_cast<std::uint8_t>(closed[idx(c)] | 1U << k);
                auto& other = closed[idx(p.grid.id(x, y))];
                other = static_cast<std::uint8_t>(other | 1U << (k + 4));
            }
        }
        Flood flood(p.grid, p.set, closed, far_enough);
        std::vector<std::int64_t> far(p.set.size(), Flood::unreached);
        for (int s = 0; s < 3; ++s) {
            const auto c = static_cast<std::int64_t>(random() % p.set.size());
            if (p.set[idx(c)] == 0) continue;
            flood.add_source(c, s);
            far[idx(c)] = 0;
        }
        flood.run();
        const auto steps = [&](std::int64_t c, auto&& f) {
            for (std::size_t k = 0; k < 8; ++k) {
                const std::int32_t x = p.grid.ix(c) + around_dx[k];
                const std::int32_t y = p.grid.iy(c) + around_dy[k];
                if (!p.has(x, y) || (closed[idx(c)] >> k & 1U) != 0) continue;
                f(p.grid.id(x, y), k % 2 == 0 ? 10 : 14);
            }
        };
        for (bool changed = true; changed;) {
            changed = false;
            for (std::int64_t c = 0; c < p.grid.size(); ++c) {
                if (far[idx(c)] == Flood::unreached) continue;
                steps(c, [&](std::int64_t n, int d) {
                    if (far[idx(c)] + d >= far[idx(n)]) return;
                    far[idx(n)] = far[idx(c)] + d;
                    changed = true;
                });
            }
        }
        for (std::int64_t c = 0; c < p.grid.size(); ++c) {
            ASSERT_EQ(flood.distance(c), far[idx(c)]);
            if (far[idx(c)] == Flood::unreached) continue;
            const auto path = flood.path_to(c);
            int length = 0;
            for (std::size_t i = 0; i + 1 < path.size(); ++i) {
                int step = 0;
                steps(path[i], [&](std::int64_t n, int d) { step = n == path[i + 1] ? d : step; });
                ASSERT_GT(step, 0);
                length += step;
            }
            EXPECT_EQ(length, far[idx(c)]);
            EXPECT_EQ(flood.source(c), flood.source(path.front()));
        }
    }
}

// A random domain with walls between its cells, and sources in it.
struct Land {
    Picture domain;
    Raster<std::uint8_t> closed;
    std::vector<std::pair<std::int64_t, std::int32_t>> sources;  // cell and name

    Land(std::mt19937_64& random, std::int32_t nx, std::int32_t ny, int count)
        : domain(test::random_domain(random, nx, ny)), closed(domain.set.size(), 0) {
        const Grid& grid = domain.grid;
        for (std::int64_t c = 0; c < grid.size(); ++c) {
            for (std::size_t k = 0; k < 4; ++k) {
                const std::int32_t x = grid.ix(c) + around_dx[k];
                const std::int32_t y = grid.iy(c) + around_dy[k];
                if (!grid.inside(x, y) || random() % 7 != 0) continue;
                closed[idx(c)] = static_cast<std::uint8_t>(closed[idx(c)] | 1U << k);
                auto& other = closed[idx(grid.id(x, y))];
                other = static_cast<std::uint8_t>(other | 1U << (k + 4));
            }
        }
        for (std::int32_t name = 0; name < count; ++name) {
            const auto c = static_cast<std::int64_t>(random() % domain.set.size());
            if (domain.set[idx(c)] != 0) sources.emplace_back(c, name);
        }
        std::shuffle(sources.begin(), sources.end(), random);
    }
    Flood flooded(std::int32_t most) const {
        Flood flood(domain.grid, domain.set, closed, most);
        for (const auto& [cell, name] : sources) flood.add_source(cell, name);
        flood.run();
        return flood;
    }
};

// Dijkstra as in the book, with an order over (distance, name of the source) alone; the way back
// leads over the neighbour with the least number that is nearer by the step and has the source.
struct Book {
    std::vector<std::tuple<std::int32_t, std::int32_t>> best;  // distance and source
    std::vector<std::int64_t> before;
};
Book by_the_book(const Land& land, std::int32_t most) {
    const Picture& p = land.domain;
    Book out;
    out.best.assign(p.set.size(), {Flood::unreached, -1});
    out.before.assign(p.set.size(), -1);
    std::set<std::tuple<std::int32_t, std::int32_t, std::int64_t>> open;
    for (const auto& [cell, name] : land.sources) {
        auto& here = out.best[idx(cell)];
        if (std::get<0>(here) == 0 && std::get<1>(here) < name) continue;
        here = {0, name};
        open.emplace(0, name, cell);
    }
    const auto neighbour = [&](std::int64_t c, std::size_t k) -> std::int64_t {
        const std::int32_t x = p.grid.ix(c) + around_dx[k];
        const std::int32_t y = p.grid.iy(c) + around_dy[k];
        if (!p.has(x, y) || (land.closed[idx(c)] >> k & 1U) != 0) return -1;
        return p.grid.id(x, y);
    };
    while (!open.empty()) {
        const auto [far, name, cell] = *open.begin();
        open.erase(open.begin());
        if (out.best[idx(cell)] != std::tuple(far, name)) continue;
        for (std::size_t k = 0; k < 8; ++k) {
            const std::int64_t n = neighbour(cell, k);
            const std::tuple to(far + (k % 2 == 0 ? 10 : 14), name);
            if (n < 0 || std::get<0>(to) > most || out.best[idx(n)] <= to) continue;
            // An unreached cell sorts behind all, for its distance.
            out.best[idx(n)] = to;
            open.emplace(std::get<0>(to), name, n);
        }
    }
    for (std::int64_t c = 0; c < p.grid.size(); ++c) {
        const auto [far, name] = out.best[idx(c)];
        if (far == Flood::unreached || far == 0) continue;
        for (std::size_t k = 0; k < 8 && out.before[idx(c)] < 0; ++k) {
            const std::int64_t n = neighbour(c, k);
            if (n < 0) continue;
            if (out.best[idx(n)] == std::tuple(far - (k % 2 == 0 ? 10 : 14), name)) {
                out.before[idx(c)] = n;
            }
        }
    }
    return out;
}

TEST(Flood, EqualsDijkstraWithTheSameTieRule) {
    std::mt19937_64 random(10);
    std::int64_t reached = 0;
    for (int round = 0; round < 60; ++round) {
        const Land land(random, 31, 27, 2 + round % 9);
        const std::int32_t most = round % 3 == 0 ? 83 : far_enough;
        const Flood flood = land.flooded(most);
        const Book book = by_the_book(land, most);
        for (std::int64_t c = 0; c < land.domain.grid.size(); ++c) {
            const auto [far, name] = book.best[idx(c)];
            ASSERT_EQ(flood.distance(c), far);
            ASSERT_EQ(flood.source(c), name);
            if (far == Flood::unreached) continue;
            ++reached;
            std::vector<std::int64_t> path;
            for (std::int64_t b = c; b >= 0; b = book.before[idx(b)]) path.push_back(b);
            std::reverse(path.begin(), path.end());
            ASSERT_EQ(flood.path_to(c), path);
        }
    }
    EXPECT_GT(reached, 10000);
}

TEST(Flood, TheOrderOfSourcesPlaysNoPart) {
    std::mt19937_64 random(11);
    for (int round = 0; round < 20; ++round) {
        Land land(random, 29, 33, 12);
        // Two names for one cell, too.
        if (!land.sources.empty()) land.sources.emplace_back(land.sources.front().first, 99);
        const Flood one = land.flooded(far_enough);
        for (int again = 0; again < 4; ++again) {
            std::shuffle(land.sources.begin(), land.sources.end(), random);
            const Flood other = land.flooded(far_enough);
            for (std::int64_t c = 0; c < land.domain.grid.size(); ++c) {
                ASSERT_EQ(one.distance(c), other.distance(c));
                ASSERT_EQ(one.source(c), other.source(c));
                if (one.distance(c) == Flood::unreached) continue;
                ASSERT_EQ(one.path_to(c), other.path_to(c));
            }
        }
    }
}

// As far from the window's edge as the flood goes, it does not notice the edge.
TEST(Flood, AWindowGivesTheSameWithinReach) {
    std::mt19937_64 random(12);
    constexpr std::int32_t most = 60;  // six cells
    constexpr std::int32_t margin = 6;
    std::int64_t reached = 0;
    for (int round = 0; round < 30; ++round) {
        const Land land(random, 47, 41, 14);
        const Grid& grid = land.domain.grid;
        const Flood whole = land.flooded(most);
        const Window core{12 + round % 5, 9, 30, 28 + round % 7};
        const Window around = core.grown(margin, grid);
        const Grid part = part_of(grid, around);
        Raster<std::uint8_t> free(idx(around.size()));
        Raster<std::uint8_t> closed(free.size());
        const auto to_whole = [&](std::int64_t c) {
            return grid.id(part.ix(c) + around.x_begin, part.iy(c) + around.y_begin);
        };
        for (std::int64_t c = 0; c < part.size(); ++c) {
            free[idx(c)] = land.domain.set[idx(to_whole(c))];
            closed[idx(c)] = land.closed[idx(to_whole(c))];
        }
        Flood flood(part, free, closed, most);
        for (const auto& [cell, name] : land.sources) {
            const std::int32_t x = grid.ix(cell);
            const std::int32_t y = grid.iy(cell);
            if (!around.contains(x, y)) continue;
            flood.add_source(part.id(x - around.x_begin, y - around.y_begin), name);
        }
        flood.run();
        for (std::int64_t c = 0; c < part.size(); ++c) {
            const std::int64_t w = to_whole(c);
            if (!core.contains(grid.ix(w), grid.iy(w))) continue;
            ASSERT_EQ(flood.distance(c), whole.distance(w));
            ASSERT_EQ(flood.source(c), whole.source(w));
            if (flood.distance(c) == Flood::unreached) continue;
            ++reached;
            std::vector<std::int64_t> path = flood.path_to(c);
            for (std::int64_t& cell : path) cell = to_whole(cell);
            ASSERT_EQ(path, whole.path_to(w));
        }
    }
    EXPECT_GT(reached, 1000);
}

}  // namespace
}  // namespace vfplan
