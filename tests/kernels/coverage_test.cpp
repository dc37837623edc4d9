#include "kernels/coverage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

using test::bounds_of;
using test::wall;

constexpr Scanner unlimited{0, 1000, 90};

CoverageRow row_at(const std::vector<Wall>& walls, const Pieces& pieces, const Vec2d& eye,
                   double fraction, const Scanner& scanner = unlimited) {
    Box box = bounds_of(walls);
    box.add(eye);
    const ExactScene scene(walls, box, scanner.range_max_m);
    return coverage_row(walls, pieces, eye, test::look(scene, walls, scanner, eye), fraction);
}

TEST(Pieces, SidesAreCutIntoTheFewestEqualPieces) {
    for (const auto& [length, count] :
         {std::pair(0.3, 1), std::pair(5.0, 1), std::pair(5.001, 2), std::pair(10.0, 2),
          std::pair(10.5, 3), std::pair(99.0, 20)}) {
        const Pieces p = cut_into_pieces({wall({1, 1}, {1, 1 + length})}, 5);
        ASSERT_EQ(p.size(), 2 * count) << length;  // two sides
        for (int i = 0; i < count; ++i) {
            EXPECT_NEAR(p.length_m(i), length / count, 1e-12);
            EXPECT_NEAR(p.place(i).s0_m, i * length / count, 1e-12);
            EXPECT_EQ(p.place(i).side, left);
            EXPECT_EQ(p.place(i + count).side, right);
        }
        EXPECT_NEAR(p.place(count - 1).s1_m, length, 1e-12);
    }
}

TEST(Pieces, RoundingMakesNoExtraPiece) {
    for (int n = 1; n < 200; ++n) {
        EXPECT_EQ(cut_into_pieces({wall({0, 0}, {0.1 * n, 0})}, 0.1).size(), 2 * n);
    }
}

TEST(Pieces, OnlyFreeSidesOfWallsToScan) {
    std::vector<Wall> walls(4, wall({0, 0}, {10, 0}));
    walls[0].free_side[left] = false;
    walls[1].free_side[right] = false;
    walls[2].scanned = false;
    const Pieces p = cut_into_pieces(walls, 5);
    std::vector<std::int32_t> wall_of;
    std::vector<std::int32_t> side_of;
    for (std::int64_t i = 0; i < p.size(); ++i) {
        wall_of.push_back(p.place(i).wall);
        side_of.push_back(p.place(i).side);
    }
    EXPECT_EQ(wall_of, (std::vector<std::int32_t>{0, 0, 1, 1, 3, 3, 3, 3}));
    EXPECT_EQ(side_of, (std::vector<std::int32_t>{1, 1, 0, 0, 0, 0, 1, 1}));
    std::vector<std::int32_t> first;
    std::vector<std::int32_t> count;
    for (std::int32_t w = 0; w < 4; ++w) {
        for (const Side side : {left, right}) {
            count.push_back(p.count(w, side));
            first.push_back(p.count(w, side) > 0 ? p.first(w, side) : -1);
        }
    }
    EXPECT_EQ(first, (std::vector<std::int32_t>{-1, 0, 2, -1, -1, -1, 4, 6}));
    EXPECT_EQ(count, (std::vector<std::int32_t>{0, 2, 2, 0, 0, 0, 2, 2}));
    EXPECT_EQ(p.walls(), 4);
    EXPECT_EQ(p.wall_length_m(2), 10);
}

// Each piece is where counting up from the first wall puts it, and none is missed.
TEST(Pieces, PlacesAreThoseOfCountingUp) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> coordinate(0, 60);
    for (int round = 0; round < 20; ++round) {
        std::vector<Wall> walls;
        for (int w = 0; w < 40; ++w) {
            walls.push_back(wall({coordinate(random), coordinate(random)},
                                 {coordinate(random), coordinate(random)}));
            walls.back().free_side[left] = random() % 4 != 0;
            walls.back().free_side[right] = random() % 4 != 0;
            walls.back().scanned = random() % 5 != 0;
        }
        const Pieces p = cut_into_pieces(walls, 1.7);
        std::int64_t next = 0;
        for (std::int32_t w = 0; w < 40; ++w) {
            const Wall& at = walls[static_cast<std::size_t>(w)];
            const std::int32_t n = at.scanned ? pieces_along(at.length_m(), 1.7) : 0;
            for (const Side side : {left, right}) {
                ASSERT_EQ(p.count(w, side), at.free_side[side] ? n : 0);
                for (std::int32_t k = 0; k < p.count(w, side); ++k, ++next) {
                    const Pieces::Place place = p.place(next);
                    ASSERT_EQ(place.wall, w);
                    ASSERT_EQ(place.side, side);
                    EXPECT_EQ(place.s0_m, piece_begin_m(at.length_m(), k, n));
                    EXPECT_EQ(place.s1_m, piece_begin_m(at.length_m(), k + 1, n));
                    EXPECT_EQ(p.length_m(next), place.s1_m - place.s0_m);
                }
            }
        }
        EXPECT_EQ(p.size(), next);
    }
}

TEST(Coverage, OnlyTheSideThatFacesTheEye) {
    const std::vector<Wall> walls = {wall({-10, 0}, {10, 0})};
    const Pieces p = cut_into_pieces(walls, 5);
    for (const double y : {3.0, -3.0}) {
        const CoverageRow row = row_at(walls, p, {1, y}, 0.5);
        ASSERT_EQ(row.size(), 4U);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(row[i].piece, static_cast<std::int32_t>(i) + (y > 0 ? 0 : 4));
            EXPECT_EQ(row[i].fraction, 1);
        }
    }
}

TEST(Coverage, BuriedSidesAreNobodysToCover) {
    std::vector<Wall> walls = {wall({-10, 0}, {10, 0})};
    walls[0].free_side[left] = false;
    const Pieces p = cut_into_pieces(walls, 5);
    EXPECT_TRUE(row_at(walls, p, {1, 3}, 0).empty());
    EXPECT_EQ(row_at(walls, p, {1, -3}, 0).size(), 4U);
}

// A wall of one 10 m piece at distance 3, of which the range circle shows exactly `half_width`
// to one side of the foot at its end.
CoverageRow seen_through_a_range(double shown_m, double fraction) {
    const std::vector<Wall> walls = {wall({0, 0}, {10, 0})};
    const Pieces p = cut_into_pieces(walls, 10);
    return row_at(walls, p, {0, 3}, fraction, {0, std::sqrt(9 + shown_m * shown_m), 90});
}

TEST(Coverage, FractionThresholdIncludesExactlyHalf) {
    EXPECT_EQ(seen_through_a_range(5, 0.5).size(), 1U);  // 3-4-5: sqrt(34) and back
    EXPECT_EQ(seen_through_a_range(4.999, 0.5).size(), 0U);
    EXPECT_EQ(seen_through_a_range(4, 0.4).size(), 1U);
    EXPECT_EQ(seen_through_a_range(4, 0.41).size(), 0U);
    EXPECT_EQ(seen_through_a_range(0.1, 0).size(), 1U);
    const CoverageRow row = seen_through_a_range(4, 0);
    EXPECT_FLOAT_EQ(row.at(0).fraction, 0.4F);
    EXPECT_FLOAT_EQ(row.at(0).angle_rad, static_cast<float>(std::atan(4 / 3.0)));
}

TEST(Coverage, HalfAPieceBehindAPost) {
    // The post's shadow on y = 10 runs from x = 0 to 5: half of the piece.
    const std::vector<Wall> walls = {wall({10, 10}, {0, 10}), wall({0, 5}, {2.5, 5})};
    const Pieces p = cut_into_pieces(walls, 10);
    const auto covers_first = [&](double fraction) {
        const CoverageRow row = row_at(walls, p, {0, 0}, fraction);
        return !row.empty() && row.front().piece == 0;
    };
    EXPECT_TRUE(covers_first(0.5));
    EXPECT_FALSE(covers_first(0.51));
}

TEST(Coverage, PartsOfABrokenPieceAddUp) {
    // A post in the middle hides x = 4 to 6 of the piece; range_min hides nothing.
    const std::vector<Wall> walls = {wall({10, 10}, {0, 10}), wall({4.5, 5}, {5.5, 5})};
    const Pieces p = cut_into_pieces(walls, 10);
    const CoverageRow row = row_at(walls, p, {5, 0}, 0.5);
    ASSERT_FALSE(row.empty());
    EXPECT_EQ(row[0].piece, 0);
    EXPECT_FLOAT_EQ(row[0].fraction, 0.8F);
    EXPECT_NEAR(static_cast<double>(row[0].angle_rad), 2 * (std::atan(0.5) - std::atan(0.1)), 1e-6);
}

TEST(Coverage, IncidenceAndRangeLimitWhatCounts) {
    const std::vector<Wall> walls = {wall({-50, 0}, {50, 0})};
    const Pieces p = cut_into_pieces(walls, 1);
    // 45 degrees at distance 4: 4 m to both sides.
    EXPECT_EQ(row_at(walls, p, {0, 4}, 1, {0, 100, 45}).size(), 8U);
    EXPECT_EQ(row_at(walls, p, {0, 4}, 1, {0, 5, 90}).size(), 6U);
    EXPECT_EQ(row_at(walls, p, {0, 4}, 1, {5, std::sqrt(116.0), 90}).size(), 14U);
}

TEST(Coverage, AnglesAndLengthsAddUpToTheView) {
    std::mt19937_64 random(1);
    auto walls = test::scattered_squares(5, random);
    for (Wall& w : walls) w.free_side[left] = false;  // the inside of the squares
    const Box box = bounds_of(walls);
    const ExactScene scene(walls, box, 1000);
    for (const double partition : {0.3, 2.0, 50.0}) {
        const Pieces p = cut_into_pieces(walls, partition);
        for (int i = 0; i < 30; ++i) {
            const Vec2d eye = test::random_eye(walls, box, random);
            const View v = test::look(scene, walls, {2, 40, 80}, eye);
            const CoverageRow row = coverage_row(walls, p, eye, v, 0);
            double angle = 0;
            double length = 0;
            double seen = 0;
            std::int32_t last = -1;
            for (const Seen& s : row) {
                EXPECT_GT(s.piece, last);
                last = s.piece;
                EXPECT_GT(s.fraction, 0);
                EXPECT_LE(s.fraction, 1);
                angle += static_cast<double>(s.angle_rad);
                length += static_cast<double>(s.fraction) * p.length_m(s.piece);
            }
            for (const Span& s : v) seen += std::abs(s.s_end_m - s.s_begin_m);
            EXPECT_NEAR(angle, view_angle_rad(v), 1e-5);
            EXPECT_NEAR(length, seen, 1e-4);
            for (const double fraction : {0.2, 0.5, 1.0}) {
                const CoverageRow kept = coverage_row(walls, p, eye, v, fraction);
                const auto want = std::count_if(row.begin(), row.end(), [&](const Seen& s) {
                    return static_cast<double>(s.fraction) >= fraction - 1e-7;
                });
                EXPECT_EQ(static_cast<std::int64_t>(kept.size()), want);
            }
        }
    }
}

}  // namespace
}  // namespace vfplan
