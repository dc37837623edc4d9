// Nobody who sees any of a piece is missed, and little else is said.
#include "kernels/weak_view.h"

#include <gtest/gtest.h>

#include <set>

#include "kernels/coverage.h"
#include "kernels/index.h"
#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

using test::bounds_of;
using test::rectangle;
using test::scattered_squares;

bool inside(std::span<const Vec2d> polygon, const Vec2d& p) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2d& a = polygon[i];
        const Vec2d& b = polygon[(i + 1) % polygon.size()];
        if (orient(a, b, p) < -1e-6 * (b - a).norm()) return false;
    }
    return true;
}

bool may_see(const WeakView& view, const Pieces::Place& piece, double reach_m, const Vec2d& eye) {
    bool found = false;
    const bool known =
        view.parts(piece.wall, piece.side, piece.s0_m, piece.s1_m, reach_m,
                   [&](std::span<const Vec2d> part) { found = found || inside(part, eye); });
    return found || !known;
}

// Pieces that an eye sees anything of.
std::set<std::int32_t> seen_from(const std::vector<Wall>& walls, const ExactScene& scene,
                                 const Pieces& pieces, double reach_m, const Vec2d& eye) {
    View hits;
    View observed;
    scene.first_hits(eye, hits);
    observe(walls, {0, reach_m, 90}, eye, hits, observed);
    std::set<std::int32_t> out;
    for (const Seen& s : coverage_row(walls, pieces, eye, observed, 0)) out.insert(s.piece);
    return out;
}

TEST(WeakView, MissesNobodyWhoSees) {
    std::int64_t seen = 0;
    std::int64_t too_many = 0;
    std::int64_t asked = 0;
    for (unsigned seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(seed);
        const std::vector<Wall> walls = scattered_squares(4, random);
        const Box box = bounds_of(walls);
        const double reach_m = seed % 2 == 0 ? 12 : 100;
        const Pieces pieces = cut_into_pieces(walls, seed % 3 == 0 ? 0.3 : 2);
        const ExactScene scene(walls, box, reach_m);
        const WeakView view(walls, box);
        std::uniform_real_distribution<double> x(box.min.x(), box.max.x());
        std::uniform_real_distribution<double> y(box.min.y(), box.max.y());
        for (int i = 0; i < 25; ++i) {
            const Vec2d eye(x(random), y(random));
            const std::set<std::int32_t> sees = seen_from(walls, scene, pieces, reach_m, eye);
            for (std::int32_t p = 0; p < pieces.size(); ++p) {
                const bool may = may_see(view, pieces.place(p), reach_m, eye);
                EXPECT_TRUE(may || !sees.contains(p)) << "piece " << p;
                seen += sees.contains(p) ? 1 : 0;
                too_many += may && !sees.contains(p) ? 1 : 0;
                ++asked;
            }
        }
    }
    EXPECT_GT(seen, 5000);
    EXPECT_LT(too_many, seen);
    EXPECT_LT(seen + too_many, asked / 2);
}

TEST(WeakView, SeesThroughADoorAndNoFarther) {
    // Two rooms with a door from 4 to 5 m in the wall between them.
    std::vector<Wall> walls = rectangle({0, 0}, {20, 10});
    walls.erase(walls.begin() + 2);
    walls.erase(walls.begin());
    for (const auto& [a, b] :
         {std::pair(Vec2d(0, 0), Vec2d(10, 0)), std::pair(Vec2d(10, 0), Vec2d(20, 0)),
          std::pair(Vec2d(20, 10), Vec2d(10, 10)), std::pair(Vec2d(10, 10), Vec2d(0, 10)),
          std::pair(Vec2d(10, 0), Vec2d(10, 4)), std::pair(Vec2d(10, 5), Vec2d(10, 10))}) {
        walls.push_back(test::wall(a, b));
    }
    const WeakView view(walls, bounds_of(walls));
    // The west wall, seen from inside: its side is the right one or the left as it was drawn.
    std::int32_t west = -1;
    for (std::size_t w = 0; w < walls.size(); ++w) {
        if (walls[w].a.x() == 0 && walls[w].b.x() == 0) west = static_cast<std::int32_t>(w);
    }
    const Wall& wall = walls[idx(west)];
    const Side inner = orient(wall.a, wall.b, {5, 5}) > 0 ? left : right;
    const auto sees = [&](double s0, double s1, const Vec2d& eye, double reach_m = 100) {
        const double from = inner == left ? wall.length_m() - s1 : s0;
        const double to = inner == left ? wall.length_m() - s0 : s1;
        return may_see(view, {west, inner, from, to}, reach_m, eye);
    };
    EXPECT_TRUE(sees(4, 5, {5, 9}));
    EXPECT_TRUE(sees(4, 5, {19, 4.5}));
    EXPECT_FALSE(sees(4, 5, {11, 9}));
    EXPECT_FALSE(sees(4, 5, {19, 9.5}));
    EXPECT_TRUE(sees(0, 10, {11, 9}) || sees(0, 10, {11, 5.5}));
    EXPECT_FALSE(sees(4, 5, {19, 4.5}, 9));
    EXPECT_EQ(view.space(west, inner),
              view.space(1, orient(walls[1].a, walls[1].b, {15, 5}) > 0 ? left : right));
}

TEST(WeakView, ClosedRingsAreSpacesOfTheirOwn) {
    std::vector<Wall> walls = rectangle({0, 0}, {10, 10});
    const std::vector<Wall> inner = rectangle({3, 3}, {6, 6});
    walls.insert(walls.end(), inner.begin(), inner.end());
    const WeakView view(walls, bounds_of(walls));
    std::set<std::int32_t> outer_left;
    std::set<std::int32_t> inner_left;
    for (std::int32_t w = 0; w < 4; ++w) {
        outer_left.insert(view.space(w, left));
        inner_left.insert(view.space(w + 4, left));
        EXPECT_EQ(view.space(w + 4, right), view.space(0, left));
        EXPECT_NE(view.space(w, right), view.space(0, left));
    }
    EXPECT_EQ(outer_left.size(), 1U);
    EXPECT_EQ(inner_left.size(), 1U);
    EXPECT_NE(*outer_left.begin(), *inner_left.begin());
    EXPECT_EQ(view.spaces(), 3);
}

}  // namespace
}  // namespace vfplan
