// Views with known answers, for both kernels.
#include "kernels/view.h"

#include <gtest/gtest.h>

#include <thread>

#include "io/site/site_reader.h"
#include "kernels/error.h"
#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

using test::add_ring;
using test::bounds_of;
using test::kernel_named;
using test::look;
using test::rectangle;
using test::wall;

constexpr double whole = 2 * pi;
constexpr Scanner unlimited{0, 1000, 90};

class ViewTest : public testing::TestWithParam<const char*> {
protected:
    View view(const std::vector<Wall>& walls, const Vec2d& eye,
              const Scanner& scanner = unlimited) const {
        Box box = bounds_of(walls);
        box.add(eye);
        return look(*kernel_named(GetParam(), walls, box, scanner.range_max_m), walls, scanner,
                    eye);
    }
    // Rays are cast 1e-9 rad beside each wall's end: that much angle a change of wall may lose.
    double tolerance() const { return std::string(GetParam()) == "exact" ? 1e-9 : 2e-8; }
    double vf(const std::vector<Wall>& walls, const Vec2d& eye,
              const Scanner& scanner = unlimited) const {
        return view_angle_rad(view(walls, eye, scanner));
    }
};

INSTANTIATE_TEST_SUITE_P(Kernels, ViewTest, testing::Values("exact", "embree"),
                         [](const auto& test) { return std::string(test.param); });

// The stretches of one wall in a view, ascending; slivers of rounding left out.
std::vector<std::pair<double, double>> stretches(const View& view, std::int32_t of) {
    std::vector<std::pair<double, double>> out;
    for (const Span& s : view) {
        if (s.wall != of || s.angle_rad < 1e-8) continue;
        out.emplace_back(std::min(s.s_begin_m, s.s_end_m), std::max(s.s_begin_m, s.s_end_m));
    }
    std::sort(out.begin(), out.end());
    return out;
}

void expect_stretch(const View& view, std::int32_t of, double from, double to) {
    const auto found = stretches(view, of);
    ASSERT_EQ(found.size(), 1U) << "wall " << of;
    EXPECT_NEAR(found[0].first, from, 1e-6) << "wall " << of;
    EXPECT_NEAR(found[0].second, to, 1e-6) << "wall " << of;
}

TEST_P(ViewTest, EmptyRectangleIsSeenWhole) {
    const auto walls = rectangle({0, 0}, {20, 10});
    for (const Vec2d& eye : {Vec2d(10, 5), Vec2d(1, 1), Vec2d(19.99, 0.01), Vec2d(7.3, 8.1)}) {
        const View v = view(walls, eye);
        EXPECT_NEAR(view_angle_rad(v), whole, tolerance());
        ASSERT_EQ(v.size(), 4U);
        for (std::int32_t w = 0; w < 4; ++w) {
            expect_stretch(v, w, 0, walls[static_cast<std::size_t>(w)].length_m());
        }
        for (const Span& s : v) EXPECT_EQ(s.side, left);
    }
}

TEST_P(ViewTest, EyesCloseToCorners) {
    const auto room = rectangle({0, 0}, {20, 10});
    for (const double d : {1e-2, 1e-4, 1e-6}) {
        EXPECT_NEAR(vf(room, {d, d}), whole, 1e-6) << d;
        // Outside a corner both walls are seen to their far ends.
        const Vec2d eye(20 + d, 10 + d);
        const double want = angle_between_rad(Vec2d(0, 10) - eye, Vec2d(20, 0) - eye);
        EXPECT_NEAR(vf(room, eye), want, 1e-6) << d;
    }
}

TEST_P(ViewTest, SidesAndDirectionOfSpans) {
    const std::vector<Wall> one = {wall({-5, 0}, {5, 0})};
    const View above = view(one, {0, 2});
    ASSERT_EQ(above.size(), 1U);
    EXPECT_EQ(above[0].side, left);
    EXPECT_NEAR(above[0].s_begin_m, 0, tolerance());
    EXPECT_NEAR(above[0].s_end_m, 10, tolerance());
    const View below = view(one, {1, -2});
    ASSERT_EQ(below.size(), 1U);
    EXPECT_EQ(below[0].side, right);
    EXPECT_NEAR(below[0].s_begin_m, 10, tolerance());
    EXPECT_NEAR(below[0].s_end_m, 0, tolerance());
    EXPECT_NEAR(below[0].angle_rad, std::atan(4 / 2.0) + std::atan(6 / 2.0), tolerance());
    EXPECT_EQ(vf(one, {9, 0}), 0);  // edge-on
}

TEST_P(ViewTest, FromOutsideTheHullOfAllWalls) {
    const auto building = rectangle({0, 0}, {8, 4});
    const Vec2d eye(-50, -3);
    EXPECT_NEAR(vf(building, eye), angle_between_rad(Vec2d(8, 0) - eye, Vec2d(0, 4) - eye),
                tolerance());
    const Vec2d beside(4, 100);  // sees the north wall only
    const View v = view(building, beside);
    ASSERT_EQ(v.size(), 1U);
    EXPECT_EQ(v[0].wall, 2);
    EXPECT_EQ(v[0].side, right);
    EXPECT_NEAR(v[0].angle_rad, 2 * std::atan(4 / 96.0), tolerance());
}

TEST_P(ViewTest, PillarCastsItsShadow) {
    auto walls = rectangle({0, 0}, {20, 20});
    for (const Wall& w : rectangle({8, 9.5}, {9, 10.5})) walls.push_back(w);
    const Vec2d eye(2, 10);
    const View v = view(walls, eye);
    EXPECT_NEAR(view_angle_rad(v), whole, tolerance());
    const auto east = stretches(v, 1);
    ASSERT_EQ(east.size(), 2U);
    EXPECT_NEAR(east[0].second, 10 - 18 * 0.5 / 6, 1e-6);
    EXPECT_NEAR(east[1].first, 10 + 18 * 0.5 / 6, 1e-6);
    expect_stretch(v, 7, 0, 1);                    // the pillar's west face
    for (const std::int32_t hidden : {4, 5, 6}) {  // and nothing of its other faces
        EXPECT_TRUE(stretches(v, hidden).empty());
    }
}

TEST_P(ViewTest, WallsThatNeedNoScanOccludeAndGiveNoSpan) {
    auto walls = rectangle({0, 0}, {20, 20});
    for (Wall w : rectangle({8, 9.5}, {9, 10.5})) {
        w.scanned = false;
        walls.push_back(w);
    }
    const View v = view(walls, {2, 10});
    EXPECT_NEAR(view_angle_rad(v), whole - 2 * std::atan(0.5 / 6), tolerance());
    for (const Span& s : v) EXPECT_LT(s.wall, 4);
    EXPECT_EQ(stretches(v, 1).size(), 2U);
}

TEST_P(ViewTest, CorridorIsOpenAtItsEnds) {
    const std::vector<Wall> walls = {wall({-100, -1}, {100, -1}), wall({-100, 1}, {100, 1})};
    EXPECT_NEAR(vf(walls, {0, 0}), whole - 4 * std::atan(0.01), tolerance());
    EXPECT_NEAR(vf(walls, {0, 0}, {0, 10, 90}), 4 * std::acos(0.1), tolerance());
}

TEST_P(ViewTest, DoorLetsAWedgeThrough) {
    std::vector<Wall> walls = {wall({0, 0}, {10, 0}),    wall({10, 0}, {20, 0}),
                               wall({20, 0}, {20, 10}),  wall({20, 10}, {10, 10}),
                               wall({10, 10}, {0, 10}),  wall({0, 10}, {0, 0}),
                               wall({10, 0}, {10, 4.5}), wall({10, 5.5}, {10, 10})};
    const View v = view(walls, {5, 5});
    EXPECT_NEAR(view_angle_rad(v), whole, tolerance());
    expect_stretch(v, 2, 3.5, 6.5);
    EXPECT_TRUE(stretches(v, 1).empty());
    EXPECT_TRUE(stretches(v, 3).empty());
    expect_stretch(v, 6, 0, 4.5);
    expect_stretch(v, 7, 0, 4.5);
}

TEST_P(ViewTest, CornerOfAnLHidesItsOtherArm) {
    std::vector<Wall> walls;
    add_ring(walls, {{0, 0}, {10, 0}, {10, 4}, {4, 4}, {4, 10}, {0, 10}});
    const View v = view(walls, {9, 1});
    EXPECT_NEAR(view_angle_rad(v), whole, tolerance());
    expect_stretch(v, 5, 3.6, 10);  // x = 0, from y = 6.4 down
    EXPECT_TRUE(stretches(v, 3).empty());
    EXPECT_TRUE(stretches(v, 4).empty());
}

TEST_P(ViewTest, CrossingWallsAreSeenToTheirCrossing) {
    FeatureSet set;
    Feature fences;
    fences.number = 1;
    fences.role = Role::wall;
    fences.lines = {{{-10, 0}, {10, 0}}, {{0, -10}, {0, 10}}, {{0, 0}, {10, 0}}};
    set.features = {fences};
    const Site site = build_site(set, {}, "fences").site;
    const Vec2d eye = Vec2d(1, 1) - site.origin;
    const Vec2d up = Vec2d(0, 10) - Vec2d(1, 1);
    const Vec2d along = Vec2d(10, 0) - Vec2d(1, 1);
    const View v = view(site.walls, eye);
    EXPECT_NEAR(view_angle_rad(v), angle_between_rad(up, along), tolerance());
    int seen = 0;
    for (std::int32_t w = 0; w < static_cast<std::int32_t>(site.walls.size()); ++w) {
        seen += stretches(v, w).empty() ? 0 : 1;
        if (!stretches(v, w).empty()) expect_stretch(v, w, 0, 10);
    }
    EXPECT_EQ(site.walls.size(), 4U);
    EXPECT_EQ(seen, 2);
}

TEST_P(ViewTest, RangeRingsOnALongWall) {
    const std::vector<Wall> walls = {wall({-500, 0}, {500, 0})};
    const double h = 3;
    const auto seen = [&](double min, double max) { return vf(walls, {0, h}, {min, max, 90}); };
    EXPECT_NEAR(seen(0, 5), 2 * std::acos(h / 5), tolerance());
    EXPECT_NEAR(seen(4, 5), 2 * std::acos(h / 5) - 2 * std::acos(h / 4), tolerance());
    EXPECT_NEAR(seen(2, 5), 2 * std::acos(h / 5), tolerance());
    EXPECT_EQ(seen(0, 2.9), 0);
    EXPECT_EQ(view(walls, {0, h}, {4, 5, 90}).size(), 2U);  // broken by the range_min circle
    EXPECT_EQ(view(walls, {0, h}, {2, 5, 90}).size(), 1U);
    for (const Vec2d& eye : {Vec2d(0, h), Vec2d(0, -h)}) {
        for (const Span& s : view(walls, eye, {4, 5, 90})) {
            for (const double end : {s.s_begin_m, s.s_end_m}) {
                const double d = (walls[0].at(end) - eye).norm();
                EXPECT_TRUE(std::abs(d - 4) < 1e-9 || std::abs(d - 5) < tolerance()) << d;
            }
        }
    }
}

TEST_P(ViewTest, RangeRingsInsideACircle) {
    const int n = 128;
    const double radius = 10;
    Ring ring;
    for (int i = 0; i < n; ++i) {
        ring.push_back(radius * Vec2d(std::cos(2 * pi * i / n), std::sin(2 * pi * i / n)));
    }
    std::vector<Wall> walls;
    add_ring(walls, ring);
    const double apothem = radius * std::cos(pi / n);
    const double between = (apothem + radius) / 2;
    const double inner = 2 * n * std::acos(apothem / between);
    EXPECT_NEAR(vf(walls, {0, 0}, {0, 10.01, 90}), whole, tolerance());
    EXPECT_EQ(vf(walls, {0, 0}, {0, apothem - 1e-6, 90}), 0);
    EXPECT_EQ(vf(walls, {0, 0}, {10.01, 20, 90}), 0);
    EXPECT_NEAR(vf(walls, {0, 0}, {0, between, 90}), inner, 1e-6);
    EXPECT_NEAR(vf(walls, {0, 0}, {between, 20, 90}), whole - inner, 1e-6);
}

TEST_P(ViewTest, TooNearToBeObservedStillOccludes) {
    auto walls = rectangle({-50, -50}, {50, 50});
    walls.push_back(wall({-0.2, 0.3}, {0.2, 0.3}));
    const double hidden = 2 * std::atan(0.2 / 0.3);
    EXPECT_NEAR(vf(walls, {0, 0}, {0.6, 600, 90}), whole - hidden, tolerance());
    EXPECT_NEAR(vf(walls, {0, 0}, {0, 600, 90}), whole, tolerance());
}

TEST_P(ViewTest, IncidenceLimit) {
    const std::vector<Wall> walls = {wall({-5000, 0}, {5000, 0})};
    for (const double limit : {15.0, 45.0, 60.0}) {
        EXPECT_NEAR(vf(walls, {0, 3}, {0, 1000, limit}), 2 * limit * pi / 180, tolerance());
    }
    EXPECT_NEAR(vf(walls, {0, 3}, {0, 5, 80}), 2 * std::acos(0.6),
                tolerance());  // range is tighter
    EXPECT_NEAR(vf(walls, {0, 3}, {4, 1000, 60}), 2 * (pi / 3 - std::acos(0.75)), tolerance());
    const auto square = rectangle({0, 0}, {10, 10});
    EXPECT_NEAR(vf(square, {5, 5}, {0, 100, 30}), 8 * pi / 6, tolerance());
}

TEST_P(ViewTest, EqualInputGivesEqualBitsOnEveryThread) {
    std::mt19937_64 random(5);
    const auto walls = test::scattered_squares(5, random);
    const auto one = kernel_named(GetParam(), walls, bounds_of(walls), 100);
    const auto other = kernel_named(GetParam(), walls, bounds_of(walls), 100);
    for (int i = 0; i < 20; ++i) {
        const Vec2d eye = test::random_eye(walls, bounds_of(walls), random);
        const View a = look(*one, walls, unlimited, eye);
        View b;
        std::thread([&] { b = look(*other, walls, unlimited, eye); }).join();
        ASSERT_EQ(a.size(), b.size());
        for (std::size_t k = 0; k < a.size(); ++k) {
            EXPECT_EQ(a[k].wall, b[k].wall);
            EXPECT_EQ(a[k].s_begin_m, b[k].s_begin_m);
            EXPECT_EQ(a[k].s_end_m, b[k].s_end_m);
            EXPECT_EQ(a[k].angle_rad, b[k].angle_rad);
        }
    }
}

// A wall that the eye looks along hides nothing and breaks no span.
TEST_P(ViewTest, EdgeOnWallsBreakNothing) {
    auto walls = rectangle({-10, -10}, {10, 10});
    walls.push_back(wall({2, 0}, {4, 0}));
    walls.push_back(wall({0, 2}, {0, 4}));
    walls.push_back(wall({-2, 0}, {-4, 0}));
    walls.push_back(wall({0, -2}, {0, -4}));
    const View v = view(walls, {0, 0});
    EXPECT_NEAR(view_angle_rad(v), whole, tolerance());
    for (std::int32_t w = 0; w < 4; ++w) expect_stretch(v, w, 0, 20);
}

// In line with a wall, and a little off it: where rounding puts the eye is nothing to count on.
TEST(Observe, AWallSeenEdgeOnIsNotObserved) {
    const std::vector<Wall> walls = {wall({3, 3}, {8, 8})};
    const View whole_wall = {{0, left, 0, walls[0].length_m(), 0}};
    for (const double off : {0.0, 1e-17, 1e-14, 1e-10}) {
        View out;
        observe(walls, {0.5, 100, 90}, {1 - off, 1 + off}, whole_wall, out);
        EXPECT_TRUE(out.empty()) << off;
    }
    View out;
    observe(walls, {0.5, 100, 90}, {1 - 1e-6, 1 + 1e-6}, whole_wall, out);
    ASSERT_EQ(out.size(), 1U);
    EXPECT_NEAR(out[0].s_end_m - out[0].s_begin_m, walls[0].length_m(), 1e-9);
}

// Few rays: 22.5 degrees apart, so that whole changes of wall lie between two of them.
double seen_by_16_rays(const std::vector<Wall>& walls) {
    Box box = bounds_of(walls);
    box.add({0, 0});
    const EmbreeScene scene(walls, box, 100, 16);
    return view_angle_rad(look(scene, walls, unlimited, {0, 0}));
}

TEST(EmbreeScene, ChangesOfWallBetweenTwoRaysAreFoundExactly) {
    // The near wall ends after the far one begins.
    EXPECT_NEAR(seen_by_16_rays({wall({5, -3}, {5, 1}), wall({10, 1}, {10, 6})}),
                2 * std::atan(0.6), 1e-7);
    EXPECT_NEAR(seen_by_16_rays({wall({10, -6}, {10, 2}), wall({5, 0.5}, {5, 3})}),
                2 * std::atan(0.6), 1e-7);
    // The far one is cut where the near one begins or ends: its part is the smaller for it.
    const std::vector<Wall> limited = {wall({5, -3}, {5, 1}), wall({10, 1}, {10, 6})};
    Box box = bounds_of(limited);
    box.add({0, 0});
    const EmbreeScene scene(limited, box, 100, 16);
    const View v = look(scene, limited, {0, 9, 90}, {0, 0});  // the near one alone
    EXPECT_NEAR(view_angle_rad(v), std::atan(0.6) + std::atan(0.2), 1e-7);
    // A gap between them, open or with a wall behind it.
    const double gap = std::atan(0.2) - std::atan(0.1);
    EXPECT_NEAR(seen_by_16_rays({wall({5, -3}, {5, 0.5}), wall({5, 1}, {5, 3})}),
                2 * std::atan(0.6) - gap, 1e-7);
    EXPECT_NEAR(
        seen_by_16_rays({wall({5, -3}, {5, 0.5}), wall({5, 1}, {5, 3}), wall({20, -1}, {20, 7})}),
        2 * std::atan(0.6), 1e-7);
}

TEST(ExactScene, RefusesWallsThatCross) {
    const std::vector<Wall> walls = {wall({0, 0}, {2, 2}), wall({0, 2}, {2, 0})};
    EXPECT_THROW(ExactScene(walls, bounds_of(walls), 10), InputError);
}

TEST(ExactScene, RefusesWallsThatOverlap) {
    const std::vector<Wall> walls = {wall({0, 0}, {2, 0}), wall({1, 0}, {3, 0})};
    EXPECT_THROW(ExactScene(walls, bounds_of(walls), 10), InputError);
}

TEST(EmbreeScene, DefaultRaysGrowWithRangeAndFineness) {
    EXPECT_EQ(default_rays(600, 5), 256);
    EXPECT_EQ(default_rays(30, 0.1), 512);
    EXPECT_EQ(default_rays(1, 5), 128);
    EXPECT_EQ(default_rays(1e6, 0.1), 512);
    EXPECT_EQ(default_rays(75, 1), 256);
}

}  // namespace
}  // namespace vfplan
