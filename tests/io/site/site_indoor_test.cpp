// Floor plans: free space is inside.
#include <gtest/gtest.h>

#include "kernels/error.h"
#include "tests/data.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

using test::add_line;
using test::add_polygon;
using test::box_ring;
using test::free_towards;
using test::indoor;
using test::is_free;
using test::total_length;
using test::wall_through;

Site build(const FeatureSet& set, const SiteOptions& options = indoor()) {
    return build_site(set, options, "plan").site;
}

int free_sides(const Site& site, const Vec2d& on_wall) {
    const Wall* w = wall_through(site, on_wall);
    if (w == nullptr) return -1;
    return (w->free_side[left] ? 1 : 0) + (w->free_side[right] ? 1 : 0);
}

TEST(SiteIndoor, OutlineIsFreeInside) {
    FeatureSet set;
    add_polygon(set, Role::outline, box_ring(0, 0, 10, 8), {box_ring(4, 4, 6, 6)});
    const Site site = build(set);
    EXPECT_EQ(site.walls.size(), 8U);
    EXPECT_NEAR(site.area_m2, 80 - 4, 1e-6);
    EXPECT_TRUE(is_free(site, {1, 1}));
    EXPECT_FALSE(is_free(site, {5, 5}));
    EXPECT_FALSE(is_free(site, {-1, 5}));
    EXPECT_TRUE(free_towards(site, *wall_through(site, {5, 0}), {5, 1}));
    EXPECT_TRUE(free_towards(site, *wall_through(site, {5, 4}), {5, 3}));
    for (const Wall& w : site.walls) EXPECT_NE(w.free_side[left], w.free_side[right]);
}

TEST(SiteIndoor, LineWallsInsideHaveTwoFreeSides) {
    FeatureSet set;
    add_polygon(set, Role::outline, box_ring(0, 0, 10, 8));
    add_line(set, Role::wall, {{5, 0}, {5, 5}});
    const Site site = build(set);
    EXPECT_EQ(free_sides(site, {5, 3}), 2);
    EXPECT_EQ(free_sides(site, {2, 0}), 1);
    EXPECT_TRUE(is_free(site, {2, 4}) && is_free(site, {8, 4}));
}

// Two rooms of 5 x 5 m that share the wall x = 5, with a door from y = 2 to 3.
FeatureSet two_rooms() {
    FeatureSet set;
    add_polygon(set, Role::room, box_ring(0, 0, 5, 5));
    add_polygon(set, Role::room, box_ring(5, 0, 10, 5));
    add_line(set, Role::wall, {{5, 2}, {5, 0}, {0, 0}, {0, 5}, {10, 5}, {10, 0}, {5, 0}});
    add_line(set, Role::wall, {{5, 3}, {5, 5}});
    add_line(set, Role::door, {{5, 2}, {5, 3}});
    return set;
}

TEST(SiteIndoor, DoorsOpenOrClosed) {
    const Site open = build(two_rooms());
    EXPECT_EQ(wall_through(open, {5, 2.5}), nullptr);
    EXPECT_NEAR(open.area_m2, 50, 0.01);
    EXPECT_EQ(open.buildings, 2);
    EXPECT_TRUE(is_free(open, {5.001, 2.5}));
    SiteOptions options = indoor();
    options.doors = DoorMode::closed;
    const Site closed = build(two_rooms(), options);
    const Wall* door = wall_through(closed, {5, 2.5});
    ASSERT_NE(door, nullptr);
    EXPECT_EQ(door->cls, WallClass::door);
    EXPECT_TRUE(door->scanned);
    EXPECT_NEAR(door->length_m(), 1, 1e-9);
    EXPECT_NEAR(total_length(closed), total_length(open) + 1, 1e-9);
    EXPECT_EQ(free_sides(closed, {5, 1}), 2);
}

// A room whose south wall has a window from x = 2 to 3.
FeatureSet room_with_window() {
    FeatureSet set;
    add_polygon(set, Role::room, box_ring(0, 0, 5, 4));
    add_line(set, Role::wall, {{3, 0}, {5, 0}, {5, 4}, {0, 4}, {0, 0}, {2, 0}});
    add_line(set, Role::window, {{2, 0}, {3, 0}});
    return set;
}

TEST(SiteIndoor, WindowsAreWallsOrIgnoredOrOpenings) {
    SiteOptions options = indoor();
    const Site as_wall = build(room_with_window(), options);
    const Wall* window = wall_through(as_wall, {2.5, 0});
    ASSERT_NE(window, nullptr);
    EXPECT_EQ(window->cls, WallClass::window);
    EXPECT_TRUE(window->scanned);
    EXPECT_NEAR(window->length_m(), 1, 1e-9);  // not joined to the walls beside it
    options.windows = WindowMode::ignore;
    const Site ignored = build(room_with_window(), options);
    ASSERT_NE(wall_through(ignored, {2.5, 0}), nullptr);
    EXPECT_FALSE(wall_through(ignored, {2.5, 0})->scanned);
    EXPECT_TRUE(wall_through(ignored, {1, 0})->scanned);
    options.windows = WindowMode::opening;
    const Site opening = build(room_with_window(), options);
    EXPECT_EQ(wall_through(opening, {2.5, 0}), nullptr);
    EXPECT_NE(wall_through(opening, {1, 0}), nullptr);
}

TEST(SiteIndoor, ThickWallsAreSolid) {
    FeatureSet set;
    add_polygon(set, Role::room, box_ring(0, 0, 4, 5));
    add_polygon(set, Role::room, box_ring(4.3, 0, 9, 5));
    add_polygon(set, Role::wall, box_ring(4, 0, 4.3, 5));
    add_polygon(set, Role::wall, box_ring(-0.3, -0.3, 9.3, 5.3), {box_ring(0, 0, 9, 5)});
    const Site site = build(set);
    EXPECT_NEAR(site.area_m2, 20 + 23.5, 0.01);
    EXPECT_FALSE(is_free(site, {4.15, 2}));
    EXPECT_TRUE(free_towards(site, *wall_through(site, {4, 2}), {3, 2}));
    EXPECT_FALSE(free_towards(site, *wall_through(site, {4, 2}), {4.1, 2}));
    EXPECT_EQ(free_sides(site, {4.3, 2}), 1);
    EXPECT_EQ(free_sides(site, {2, -0.3}), 0);  // the outside of the building
}

TEST(SiteIndoor, ObstaclesTakeGroundAndNeedNoScan) {
    FeatureSet set;
    add_polygon(set, Role::outline, box_ring(0, 0, 10, 8));
    add_polygon(set, Role::obstacle, box_ring(4, 4, 5, 5));
    const Site site = build(set);
    EXPECT_NEAR(site.area_m2, 79, 1e-6);
    EXPECT_FALSE(is_free(site, {4.5, 4.5}));
    EXPECT_FALSE(wall_through(site, {4.5, 4})->scanned);
    EXPECT_EQ(wall_through(site, {4.5, 4})->cls, WallClass::obstacle);
}

// Rooms drawn with a wall each, 4 cm apart.
FeatureSet doubled_walls(bool with_rooms) {
    FeatureSet set;
    for (const Ring& ring : {box_ring(0, 0, 5, 5), box_ring(5.04, 0, 10, 5)}) {
        if (with_rooms) add_polygon(set, Role::room, ring);
        Line line = ring;
        line.push_back(ring.front());
        add_line(set, Role::wall, line);
    }
    return set;
}

TEST(SiteIndoor, SlitBetweenDoubledWallsIsNobodysToScan) {
    for (const bool with_rooms : {true, false}) {
        const Site site = build(doubled_walls(with_rooms));
        for (const double x : {5.0, 5.04}) {
            const Wall* w = wall_through(site, {x, 2});
            ASSERT_NE(w, nullptr);
            EXPECT_FALSE(free_towards(site, *w, {5.02, 2})) << with_rooms;
            EXPECT_TRUE(free_towards(site, *w, {x < 5.02 ? 4.0 : 6.0, 2})) << with_rooms;
        }
        EXPECT_FALSE(is_free(site, {5.02, 2.5})) << with_rooms;
        EXPECT_TRUE(is_free(site, {2.5, 2.5}) && is_free(site, {7.5, 2.5})) << with_rooms;
    }
}

// But whoever stands before its end looks in: its faces count.
TEST(SiteIndoor, SlitWithAnOpenEndIsNoPlaceToStand) {
    for (const double gap : {0.04, 0.005}) {
        FeatureSet set;
        add_polygon(set, Role::outline, box_ring(0, 0, 10, 8));
        add_line(set, Role::wall, {{5, 0}, {5, 5}});
        add_line(set, Role::wall, {{5 + gap, 0}, {5 + gap, 5}});
        const Site site = build(set);
        EXPECT_FALSE(is_free(site, {5 + gap / 2, 2})) << gap;
        EXPECT_EQ(free_sides(site, {5, 2}), 2) << gap;
        EXPECT_EQ(free_sides(site, {5 + gap, 2}), 2) << gap;
        EXPECT_TRUE(is_free(site, {4, 2}) && is_free(site, {6, 2}) && is_free(site, {5, 6}));
    }
}

TEST(SiteIndoor, ThickWallInsideAnOutlineIsTakenOut) {
    FeatureSet set;
    add_polygon(set, Role::outline, box_ring(0, 0, 10, 8));
    add_polygon(set, Role::wall, box_ring(4, 0, 4.3, 5));
    const Site site = build(set);
    EXPECT_NEAR(site.area_m2, 80 - 1.5, 1e-6);
    EXPECT_FALSE(is_free(site, {4.15, 2}));
    EXPECT_EQ(free_sides(site, {4, 2}), 1);
    EXPECT_EQ(free_sides(site, {4.15, 5}), 1);
}

TEST(SiteIndoor, OpenDoorJoinsRoomsDrawnApart) {
    FeatureSet set;
    for (const Ring& ring : {box_ring(0, 0, 5, 5), box_ring(5.2, 0, 10, 5)}) {
        add_polygon(set, Role::room, ring);
    }
    add_polygon(set, Role::wall, box_ring(5, 0, 5.2, 2));
    add_polygon(set, Role::wall, box_ring(5, 3, 5.2, 5));
    add_line(set, Role::door, {{5.1, 2}, {5.1, 3}});
    EXPECT_TRUE(is_free(build(set), {5.1, 2.5}));
    SiteOptions closed = indoor();
    closed.doors = DoorMode::closed;
    const Site apart = build(set, closed);
    EXPECT_EQ(wall_through(apart, {5.1, 2.5})->cls, WallClass::door);
    EXPECT_EQ(free_sides(apart, {5.1, 2.5}), 2);
    EXPECT_TRUE(is_free(apart, {5.05, 2.5}) && is_free(apart, {5.15, 2.5}));  // the reveals
}

TEST(SiteIndoor, WallsAloneTellWhatIsInside) {
    FeatureSet set;
    add_line(set, Role::wall, {{5, 2}, {5, 0}, {0, 0}, {0, 5}, {10, 5}, {10, 0}, {5, 0}});
    add_line(set, Role::wall, {{5, 3}, {5, 5}});
    const Site site = build(set);
    EXPECT_TRUE(is_free(site, {2.5, 2.5}));
    EXPECT_TRUE(is_free(site, {7.5, 2.5}));
    EXPECT_FALSE(is_free(site, {-1, 2.5}));
    EXPECT_NEAR(site.area_m2, 50, 1);
    EXPECT_EQ(free_sides(site, {5, 1}), 2);
    EXPECT_EQ(free_sides(site, {0, 1}), 1);
}

TEST(SiteIndoor, DrawingsMakeNoWalls) {
    FeatureSet set;
    add_polygon(set, Role::outline, box_ring(0, 0, 10, 8));
    add_line(set, Role::ignored, {{2, 2}, {4, 4}});
    const Site site = build(set);
    EXPECT_EQ(site.walls.size(), 4U);
    EXPECT_EQ(site.counts.ignored, 1);
}

TEST(SiteIndoor, NothingToStandOnIsAnError) {
    FeatureSet set;
    add_line(set, Role::wall, {{0, 0}, {10, 0}});
    EXPECT_THROW(build(set), InputError);
    FeatureSet empty;
    EXPECT_THROW(build(empty), InputError);
}

struct Plan {
    const char* path;
    double area_m2;  // as the data's README lists it
    int rooms;
};

TEST(SiteIndoor, OfficesAndSchoolsHaveTheirFloorArea) {
    for (const Plan& plan : {Plan{"office_milano_1", 1061, 17}, Plan{"office_village", 3359, 60},
                             Plan{"school_borchen4", 350, 10}, Plan{"school_histor4", 2771, 50},
                             Plan{"school_wilbraham", 3230, 52}}) {
        const std::string path = "plans_offices_schools/" + std::string(plan.path) + ".geojson";
        VFPLAN_NEED_DATA(path);
        const Site site = read_site(test::data_dir() / path, indoor()).site;
        EXPECT_EQ(site.buildings, plan.rooms) << path;
        EXPECT_NEAR(site.area_m2, plan.area_m2, 0.03 * plan.area_m2) << path;
    }
}

}  // namespace
}  // namespace vfplan
