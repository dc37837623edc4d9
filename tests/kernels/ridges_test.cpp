#include "kernels/ridges.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "kernels/skeleton.h"
#include "tests/kernels/raster_art.h"

namespace vfplan {
namespace {

using test::draw;
using test::Picture;

RidgeGraph take_apart(const Picture& p) {
    return ridge_graph(p.grid, test::cells_of(p, test::distance_of(p)));
}

// Prunes with the given clearances; the cells that stay are set.
std::int64_t prune(Picture& p, const DistanceField& distance) {
    SkeletonCells cells = test::cells_of(p, distance);
    const std::int64_t pruned = prune_spurs(p.grid, cells);
    p = test::picture_of(p.grid, cells);
    for (std::size_t i = 0; i < cells.cell.size(); ++i) {  // each cell keeps its clearance
        EXPECT_EQ(cells.squared[i], distance.squared[static_cast<std::size_t>(cells.cell[i])]);
    }
    return pruned;
}

TEST(Ridges, LineHasNoJoint) {
    const Picture p = draw({".........", ".#######.", "........."});
    const RidgeGraph g = take_apart(p);
    EXPECT_TRUE(g.joints.empty());
    ASSERT_EQ(g.ridges.size(), 1U);
    EXPECT_EQ(g.ridges[0].cells.size(), 7U);
    EXPECT_EQ(g.ridges[0].joint[0], -1);
    EXPECT_EQ(g.ridges[0].joint[1], -1);
    EXPECT_FALSE(g.ridges[0].ring);
    EXPECT_EQ(std::set({g.ridges[0].cells.front(), g.ridges[0].cells.back()}),
              std::set({p.grid.id(1, 1), p.grid.id(7, 1)}));
}

TEST(Ridges, CrossHasOneJointAndFourRidges) {
    const Picture p = draw({"....#....", "....#....", "....#....", "....#....", "#########",
                            "....#....", "....#....", "....#....", "....#...."});
    const RidgeGraph g = take_apart(p);
    ASSERT_EQ(g.joints.size(), 1U);
    EXPECT_EQ(g.joints[0], p.grid.id(4, 4));
    ASSERT_EQ(g.ridges.size(), 4U);
    for (const Ridge& r : g.ridges) {
        EXPECT_EQ((r.joint[0] >= 0) + (r.joint[1] >= 0), 1);
        EXPECT_EQ(r.cells.size(), 3U);  // the arms' inner cells belong to the joint's cluster
    }
}

TEST(Ridges, ClusterGivesItsCellNearestToTheCentroid) {
    // The cells with three neighbours or more are (4, 1), (3, 2), (4, 2), (5, 2).
    const Picture p = draw({"....#....", "....#....", "#########", "........."});
    const RidgeGraph g = take_apart(p);
    ASSERT_EQ(g.joints.size(), 1U);
    EXPECT_EQ(g.joints[0], p.grid.id(4, 2));
}

TEST(Ridges, TieInAClusterGoesToTheLowerRowThenColumn) {
    // Two branching cells side by side, equally far from their middle.
    const Picture level = draw({"#....#", ".#..#.", "..##..", ".#..#.", "#....#"});
    const RidgeGraph g = take_apart(level);
    ASSERT_EQ(g.joints.size(), 1U);
    EXPECT_EQ(g.joints[0], level.grid.id(2, 2));
    const Picture upright = draw({"#...#", ".#.#.", "..#..", "..#..", ".#.#.", "#...#"});
    const RidgeGraph h = take_apart(upright);
    ASSERT_EQ(h.joints.size(), 1U);
    EXPECT_EQ(h.joints[0], upright.grid.id(2, 2));
}

TEST(Ridges, TwoJointsShareARidge) {
    const Picture p =
        draw({"#...........#", ".#.........#.", "..#########..", ".#.........#.", "#...........#"});
    const RidgeGraph g = take_apart(p);
    ASSERT_EQ(g.joints.size(), 2U);
    EXPECT_LT(g.joints[0], g.joints[1]);  // by the first cell of their clusters
    int between = 0;
    for (const Ridge& r : g.ridges) {
        between += r.joint[0] >= 0 && r.joint[1] >= 0 && r.joint[0] != r.joint[1] ? 1 : 0;
        EXPECT_FALSE(r.ring);
    }
    EXPECT_EQ(between, 1);
    EXPECT_EQ(g.ridges.size(), 5U);
}

TEST(Ridges, RingWithoutJoint) {
    const Picture p = draw({"..##..", ".#..#.", "#....#", "#....#", ".#..#.", "..##.."});
    const RidgeGraph g = take_apart(p);
    EXPECT_TRUE(g.joints.empty());
    ASSERT_EQ(g.ridges.size(), 1U);
    EXPECT_TRUE(g.ridges[0].ring);
    EXPECT_EQ(g.ridges[0].cells.size(), 12U);
}

TEST(Ridges, EverySkeletonCellIsInOneRidgeOrAJointCluster) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 30; ++i) {
        Picture p = test::random_domain(random, 40, 34);
        p = test::skeleton_of(p);
        const RidgeGraph g = take_apart(p);
        std::set<std::int64_t> in_ridges;
        std::int64_t last_first = -1;
        bool last_ring = false;
        for (const Ridge& r : g.ridges) {
            for (const std::int64_t c : r.cells) EXPECT_TRUE(in_ridges.insert(c).second);
            for (std::size_t k = 1; k < r.cells.size(); ++k) {
                EXPECT_LE(std::abs(p.grid.ix(r.cells[k]) - p.grid.ix(r.cells[k - 1])), 1);
                EXPECT_LE(std::abs(p.grid.iy(r.cells[k]) - p.grid.iy(r.cells[k - 1])), 1);
            }
            EXPECT_TRUE(r.ring != last_ring || r.cells.front() > last_first);
            last_first = r.cells.front();
            last_ring = r.ring;
        }
        for (std::int64_t c = 0; c < p.grid.size(); ++c) {
            const bool set = p.set[static_cast<std::size_t>(c)] != 0;
            const bool branches = std::popcount(test::neighbourhood(p, c)) >= 3;
            EXPECT_EQ(in_ridges.contains(c), set && !branches);
        }
        for (const std::int64_t joint : g.joints) {
            EXPECT_NE(p.set[static_cast<std::size_t>(joint)], 0);
            EXPECT_GE(std::popcount(test::neighbourhood(p, joint)), 3);
        }
    }
}

// By the definition, on the raster: the groups of cells with three neighbours or more are joints,
// the groups of the others are ridges, and a ridge's joints are those that its cells touch.
TEST(Ridges, OfSparseCellsAreThoseOfTheRaster) {
    std::mt19937_64 random(8);
    std::size_t ridges = 0;
    for (int i = 0; i < 80; ++i) {
        // Up to the grid's border, so that rows wrap where they must not be taken for neighbours.
        const Picture p = test::skeleton_of(test::random_domain(random, 12 + i % 31, 9 + i % 27));
        const RidgeGraph g = take_apart(p);
        const auto branches = [&](std::int64_t c) {
            return std::popcount(test::neighbourhood(p, c)) >= 3;
        };
        const auto near = [&](std::int64_t c, auto&& f) {
            for (int k = 0; k < 8; ++k) {
                const std::int32_t x = p.grid.ix(c) + around_dx[k];
                const std::int32_t y = p.grid.iy(c) + around_dy[k];
                if (p.has(x, y)) f(p.grid.id(x, y));
            }
        };
        std::map<std::int64_t, std::int64_t> group;  // cell to its group's first cell
        for (std::int64_t c = 0; c < p.grid.size(); ++c) {
            if (p.set[static_cast<std::size_t>(c)] == 0 || group.contains(c)) continue;
            std::vector<std::int64_t> open = {c};
            group[c] = c;
            while (!open.empty()) {
                const std::int64_t at = open.back();
                open.pop_back();
                near(at, [&](std::int64_t n) {
                    if (branches(n) != branches(c) || group.contains(n)) return;
                    group[n] = c;
                    open.push_back(n);
                });
            }
        }
        std::set<std::int64_t> joints;
        std::map<std::int64_t, std::set<std::int64_t>> lines;    // by group, its cells
        std::map<std::int64_t, std::set<std::int64_t>> touched;  // by line, the joints' groups
        for (const auto& [c, of] : group) {
            if (branches(c)) {
                joints.insert(of);
                continue;
            }
            lines[of].insert(c);
            near(c, [&](std::int64_t n) {
                if (branches(n)) touched[of].insert(group[n]);
            });
        }
        ASSERT_EQ(g.joints.size(), joints.size());
        auto next = joints.begin();
        for (const std::int64_t j : g.joints) EXPECT_EQ(group[j], *next++);  // in their order
        ASSERT_EQ(g.ridges.size(), lines.size());
        for (const Ridge& r : g.ridges) {
            const std::int64_t of = group[r.cells.front()];
            EXPECT_EQ(std::set(r.cells.begin(), r.cells.end()), lines[of]);
            EXPECT_EQ(r.cells.size(), lines[of].size());
            std::set<std::int64_t> ends;
            for (const std::int32_t j : r.joint) {
                if (j >= 0) ends.insert(group[g.joints[static_cast<std::size_t>(j)]]);
            }
            EXPECT_EQ(ends, touched[of]);
            ++ridges;
        }
    }
    EXPECT_GT(ridges, 400U);
}

// A line of 15 cells with a spur of `length` cells at its middle, and a clearance of 4 there.
std::int64_t spurs_pruned(int length, Picture& p) {
    p = test::blank(15, 12);
    for (std::int32_t x = 0; x < 15; ++x) p.at(x, 2) = 1;
    for (std::int32_t y = 3; y < 3 + 1 + length; ++y) p.at(7, y) = 1;  // one cell joins the cluster
    DistanceField d;
    d.resize(p.grid.size());
    for (auto& squared : d.squared) squared = 16;
    return prune(p, d);
}

TEST(Ridges, SpursShorterThanTheClearanceGo) {
    Picture p;
    EXPECT_EQ(spurs_pruned(2, p), 1);
    EXPECT_FALSE(p.has(7, 5));
    for (std::int32_t x = 0; x < 15; ++x) EXPECT_TRUE(p.has(x, 2));
    EXPECT_EQ(spurs_pruned(3, p), 1);
    EXPECT_EQ(spurs_pruned(4, p), 0);  // as long as the clearance: it stays
    EXPECT_TRUE(p.has(7, 7));
}

TEST(Ridges, LinesWithoutJointsAreNoSpurs) {
    Picture p = draw({"......", ".###..", "......"});
    DistanceField d;
    d.resize(p.grid.size());
    for (auto& squared : d.squared) squared = 100;
    EXPECT_EQ(prune(p, d), 0);
    EXPECT_TRUE(p.has(1, 1) && p.has(2, 1) && p.has(3, 1));
}

TEST(Ridges, PruningKeepsTopology) {
    std::mt19937_64 random(2);
    std::int64_t pruned = 0;
    for (int i = 0; i < 60; ++i) {
        Picture p = test::random_domain(random, 44, 38);
        const DistanceField d = test::distance_of(p);
        p = test::skeleton_of(p);
        const int parts = test::parts(p);
        const int holes = test::holes(p);
        pruned += prune(p, d);
        EXPECT_EQ(test::parts(p), parts) << i;
        EXPECT_EQ(test::holes(p), holes) << i;
        EXPECT_EQ(prune(p, d), 0);  // none is left
    }
    EXPECT_GT(pruned, 50);
}

TEST(Ridges, ArcLengthAndItsMiddle) {
    Grid g;
    g.nx = g.ny = 20;
    std::vector<std::int64_t> cells;
    for (std::int32_t x = 0; x <= 6; ++x) cells.push_back(g.id(x, 0));
    for (std::int32_t k = 1; k <= 6; ++k) cells.push_back(g.id(6 + k, k));
    EXPECT_DOUBLE_EQ(arc_cells(g, cells, 0, 6), 6);
    EXPECT_DOUBLE_EQ(arc_cells(g, cells, 0, 12), 6 + 6 * std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(arc_cells(g, cells, 3, 3), 0);
    EXPECT_EQ(arc_middle(g, cells, 0, 6), 3U);
    EXPECT_EQ(arc_middle(g, cells, 4, 6), 5U);   // strictly between
    EXPECT_EQ(arc_middle(g, cells, 0, 12), 7U);  // half of 14.49 is 7.24: 6 + sqrt(2) is nearest
    EXPECT_EQ(arc_middle(g, cells, 0, 3), 1U);   // a tie goes to the first
}

}  // namespace
}  // namespace vfplan
