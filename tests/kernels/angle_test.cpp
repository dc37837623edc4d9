#include "kernels/angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace vfplan {
namespace {

void expect_atan(double x) {
    const long double want = std::atan(static_cast<long double>(x));
    EXPECT_NEAR(static_cast<double>(static_cast<long double>(atan_exact_bits(x)) - want), 0, 3e-16)
        << "x = " << x;
}

TEST(Angle, ArcTangentIsCloseEverywhere) {
    for (int i = -20000; i <= 20000; ++i) expect_atan(i * 5e-4);
    for (double x = 1e-300; x < 1e300; x *= 1.7) {
        expect_atan(x);
        expect_atan(-x);
    }
    for (const double edge : {0.66, 1.0, 2.41421356237309504880}) {  // where the formula changes
        for (const double x : {std::nextafter(edge, 0.0), edge, std::nextafter(edge, 10.0)}) {
            expect_atan(x);
        }
    }
    EXPECT_EQ(atan_exact_bits(0), 0);
    EXPECT_DOUBLE_EQ(atan_exact_bits(std::numeric_limits<double>::infinity()), pi / 2);
}

TEST(Angle, ArcTangentIsOddAndDoesNotFall) {
    double last = -pi;
    for (int i = -4000; i <= 4000; ++i) {
        const double x = i * 1e-3;
        EXPECT_EQ(atan_exact_bits(-x), -atan_exact_bits(x));
        EXPECT_GT(atan_exact_bits(x), last);
        last = atan_exact_bits(x);
    }
}

TEST(Angle, UpperHalfPlane) {
    for (int i = 0; i <= 1000; ++i) {
        const double a = pi * i / 1000;
        const double y = std::max(0.0, std::sin(a));
        EXPECT_NEAR(angle_upper_rad(3 * y, 3 * std::cos(a)), a, 1e-14);
    }
    EXPECT_EQ(angle_upper_rad(0, 0), 0);
    EXPECT_DOUBLE_EQ(angle_upper_rad(0, -1), pi);
    EXPECT_DOUBLE_EQ(angle_upper_rad(1, 0), pi / 2);
}

TEST(Angle, BetweenVectorsIsCounterClockwise) {
    EXPECT_DOUBLE_EQ(angle_between_rad({1, 0}, {0, 2}), pi / 2);
    EXPECT_DOUBLE_EQ(angle_between_rad({0, 2}, {1, 0}), 3 * pi / 2);
    EXPECT_DOUBLE_EQ(angle_between_rad({1, 0}, {-5, 0}), pi);
    EXPECT_EQ(angle_between_rad({2, 3}, {4, 6}), 0);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> number(-10, 10);
    for (int i = 0; i < 2000; ++i) {
        const Vec2d u(number(random), number(random));
        const Vec2d v(number(random), number(random));
        double want = std::atan2(v.y(), v.x()) - std::atan2(u.y(), u.x());
        if (want < 0) want += 2 * pi;
        const double got = angle_between_rad(u, v);
        EXPECT_NEAR(got, want, 1e-13);
        EXPECT_GE(got, 0);
        EXPECT_LT(got, 2 * pi);
        EXPECT_NEAR(got + angle_between_rad(v, u), 2 * pi, 1e-13);
    }
}

TEST(Angle, PseudoAngleGrowsWithTheDirection) {
    EXPECT_EQ(pseudo_angle({3, 0}), 0);
    EXPECT_EQ(pseudo_angle({0, 3}), 1);
    EXPECT_EQ(pseudo_angle({-3, 0}), 2);
    EXPECT_EQ(pseudo_angle({0, -3}), 3);
    double last = -1;
    for (int i = 0; i < 3600; ++i) {
        const double a = 2 * pi * i / 3600;
        const double p = pseudo_angle({7 * std::cos(a), 7 * std::sin(a)});
        if (i % 900 != 0) {  // there cos or sin is not exactly 0
            EXPECT_GT(p, last);
            EXPECT_LT(p, 4);
        }
        last = p;
    }
}

TEST(Angle, CircleDirectionsAreEven) {
    for (const int count : {4, 8, 64, 4096}) {
        const std::vector<Vec2d> d = circle_directions(count);
        ASSERT_EQ(d.size(), static_cast<std::size_t>(count));
        EXPECT_EQ(d[0], Vec2d(1, 0));
        EXPECT_EQ(d[d.size() / 4], Vec2d(0, 1));
        for (std::size_t i = 0; i < d.size(); ++i) {
            const double a = 2 * pi * static_cast<double>(i) / count;
            EXPECT_NEAR(d[i].x(), std::cos(a), 1e-15 * 4);
            EXPECT_NEAR(d[i].y(), std::sin(a), 1e-15 * 4);
            EXPECT_NEAR(d[i].norm(), 1, 3e-16);
        }
    }
}

}  // namespace
}  // namespace vfplan
