// Outdoor sites: polygons are solid, the ground between them is free.
#include <gtest/gtest.h>

#include "io/formats/read_features.h"
#include "kernels/error.h"
#include "tests/data.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

using test::add_line;
using test::add_polygon;
using test::box_ring;
using test::free_towards;
using test::is_free;
using test::total_length;
using test::wall_through;

Site town(const std::vector<Ring>& rings, const SiteOptions& options = {}) {
    FeatureSet set;
    for (const Ring& ring : rings) add_polygon(set, Role::building, ring);
    return build_site(set, options, "town").site;
}

void expect_one_free_side(const Site& site) {
    for (const Wall& w : site.walls) EXPECT_NE(w.free_side[left], w.free_side[right]);
}

// The message of the InputError that f throws; a failure when it does not.
template <class F>
std::string message_of(F&& f) {
    try {
        f();
    } catch (const InputError& e) {
        return e.what();
    }
    ADD_FAILURE() << "no InputError";
    return "";
}

TEST(SiteOutdoor, OneBuilding) {
    const Site site = town({box_ring(100, 200, 110, 205)});
    EXPECT_EQ(site.origin, Vec2d(100, 200));
    EXPECT_EQ(site.walls.size(), 4U);
    EXPECT_EQ(site.buildings, 1);
    EXPECT_DOUBLE_EQ(site.area_m2, 50);
    EXPECT_DOUBLE_EQ(total_length(site), 30);
    expect_one_free_side(site);
    EXPECT_TRUE(free_towards(site, *wall_through(site, {105, 200}), {105, 190}));
    EXPECT_FALSE(is_free(site, {105, 202}));
    EXPECT_TRUE(is_free(site, {99.5, 202}));
    EXPECT_EQ(site.counts.features, 1);
    EXPECT_EQ(site.counts.edges_in, 4);
    EXPECT_EQ(site.counts.walls, 4);
}

TEST(SiteOutdoor, MarginIsFreeGroundAround) {
    SiteOptions options;
    options.margin_m = 7;
    const Site site = town({box_ring(0, 0, 10, 5)}, options);
    EXPECT_EQ(site.extent.min, Vec2d(-7, -7));
    EXPECT_EQ(site.extent.max, Vec2d(17, 12));
}

TEST(SiteOutdoor, TouchingBuildingsBuryTheirSharedWall) {
    const Site site = town({box_ring(0, 0, 10, 10), box_ring(10, 0, 20, 10)});
    EXPECT_DOUBLE_EQ(total_length(site), 60);
    EXPECT_EQ(wall_through(site, {10, 5}), nullptr);
    EXPECT_EQ(site.counts.inside_solids, 1);
    EXPECT_EQ(site.counts.duplicates, 1);
    EXPECT_DOUBLE_EQ(site.area_m2, 200);
    expect_one_free_side(site);
}

TEST(SiteOutdoor, PartlySharedWallIsBuriedWhereItIsShared) {
    const Site site = town({box_ring(0, 0, 10, 10), box_ring(10, 4, 20, 20)});
    EXPECT_EQ(wall_through(site, {10, 7}), nullptr);
    EXPECT_TRUE(free_towards(site, *wall_through(site, {10, 2}), {11, 2}));
    EXPECT_TRUE(free_towards(site, *wall_through(site, {10, 15}), {9, 15}));
    EXPECT_NEAR(total_length(site), 40 + 52 - 2 * 6, 1e-9);
    expect_one_free_side(site);
}

TEST(SiteOutdoor, OverlapIsOneSolid) {
    const Site site = town({box_ring(0, 0, 10, 10), box_ring(5, 2, 15, 12)});
    EXPECT_NEAR(site.area_m2, 160, 1e-9);
    EXPECT_NEAR(total_length(site), 54, 1e-9);
    EXPECT_GE(site.counts.split, 2);
    EXPECT_GE(site.counts.inside_solids, 4);
    EXPECT_EQ(site.buildings, 2);
    expect_one_free_side(site);
}

TEST(SiteOutdoor, RepeatedBuildingCountsOnceAsWalls) {
    const Site site = town({box_ring(0, 0, 10, 10), box_ring(0, 0, 10, 10)});
    EXPECT_EQ(site.walls.size(), 4U);
    EXPECT_EQ(site.counts.duplicates, 4);
    EXPECT_DOUBLE_EQ(site.area_m2, 100);
    expect_one_free_side(site);
}

TEST(SiteOutdoor, BuildingInsideABuildingIsBuried) {
    const Site site = town({box_ring(0, 0, 10, 10), box_ring(3, 3, 6, 6)});
    EXPECT_EQ(site.walls.size(), 4U);
    EXPECT_EQ(site.counts.inside_solids, 4);
}

TEST(SiteOutdoor, CourtyardIsFreeAndItsWallsLookIntoIt) {
    FeatureSet set;
    add_polygon(set, Role::building, box_ring(0, 0, 20, 20), {box_ring(5, 5, 15, 15)});
    const Site site = build_site(set, {}, "court").site;
    EXPECT_EQ(site.walls.size(), 8U);
    EXPECT_DOUBLE_EQ(site.area_m2, 300);
    EXPECT_TRUE(is_free(site, {10, 10}));
    EXPECT_FALSE(is_free(site, {2, 10}));
    EXPECT_TRUE(free_towards(site, *wall_through(site, {10, 5}), {10, 10}));
    expect_one_free_side(site);
}

TEST(SiteOutdoor, CollinearNeighboursBecomeOneWall) {
    const Site site = town({{{0, 0}, {3, 0}, {7, 0}, {10, 0}, {10, 10}, {0, 10}}});
    EXPECT_EQ(site.walls.size(), 4U);
    EXPECT_EQ(site.counts.merged, 2);
    EXPECT_EQ(site.counts.edges_in, 6);
}

TEST(SiteOutdoor, SnapClosesGapsAndDropsTinyEdges) {
    const Site site = town(
        {{{0, 0}, {10, 0}, {10.0002, 0.0001}, {10, 10}, {0, 10}}, box_ring(10.0004, 0, 20, 10)});
    EXPECT_EQ(wall_through(site, {10, 5}), nullptr);  // the gap was below the snap
    EXPECT_EQ(site.counts.zero_length, 1);
    EXPECT_NEAR(total_length(site), 60, 1e-9);
    for (const Wall& w : site.walls) {
        for (const double v : {w.a.x(), w.a.y(), w.b.x(), w.b.y()}) {
            EXPECT_NEAR(v * 1000, std::round(v * 1000), 1e-9);
        }
    }
    SiteOptions coarse;
    coarse.snap_m = 0.1;
    const std::vector<Ring> near = {box_ring(0, 0, 10, 10), box_ring(10.04, 0, 20, 10)};
    EXPECT_EQ(town(near).walls.size(), 8U);
    EXPECT_EQ(wall_through(town(near, coarse), {10, 5}), nullptr);
}

// Who looks into the gap must not look through the buildings.
TEST(SiteOutdoor, NarrowGapKeepsItsWalls) {
    const Site site = town({box_ring(0, 0, 10, 10), box_ring(10.005, 0, 20, 10)});
    EXPECT_NE(wall_through(site, {10, 5}), nullptr);
    EXPECT_NE(wall_through(site, {10.005, 5}), nullptr);
    EXPECT_EQ(site.counts.inside_solids, 0);
}

TEST(SiteOutdoor, FencesHaveTwoFreeSidesAndObstaclesNeedNoScan) {
    FeatureSet set;
    add_polygon(set, Role::building, box_ring(0, 0, 10, 10));
    add_line(set, Role::wall, {{5, 5}, {25, 5}});  // begins inside the building
    add_polygon(set, Role::obstacle, box_ring(40, 0, 42, 2));
    const Site site = build_site(set, {}, "fence").site;
    const Wall* fence = wall_through(site, {20, 5});
    ASSERT_NE(fence, nullptr);
    EXPECT_TRUE(fence->free_side[left] && fence->free_side[right]);
    EXPECT_NEAR(fence->length_m(), 15, 1e-9);
    EXPECT_EQ(wall_through(site, {7, 5}), nullptr);
    const Wall* obstacle = wall_through(site, {41, 0});
    ASSERT_NE(obstacle, nullptr);
    EXPECT_FALSE(obstacle->scanned);
    EXPECT_EQ(obstacle->cls, WallClass::obstacle);
    EXPECT_TRUE(wall_through(site, {3, 0})->scanned);
}

TEST(SiteOutdoor, InvalidPolygonIsNamedWithItsPlace) {
    FeatureSet set;
    add_polygon(set, Role::building, box_ring(100, 100, 101, 101));
    add_polygon(set, Role::building, {{0, 0}, {10, 10}, {10, 0}, {0, 10}});
    set.features[1].id = "way/42";
    const std::string message = message_of([&] { build_site(set, {}, "bow.geojson"); });
    for (const char* part :
         {"bow.geojson", "feature 2", "way/42", "Self-intersection", "(5.000, 5.000)", "repair"}) {
        EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    }
    SiteOptions repair;
    repair.invalid = InvalidPolygons::repair;
    const Site repaired = build_site(set, repair, "bow").site;
    EXPECT_EQ(repaired.counts.repaired, 1);
    EXPECT_NEAR(repaired.area_m2, 51, 1e-9);  // two triangles of 25 and the little square
    SiteOptions drop;
    drop.invalid = InvalidPolygons::drop;
    const Site dropped = build_site(set, drop, "bow").site;
    EXPECT_EQ(dropped.counts.dropped_invalid, 1);
    EXPECT_NEAR(dropped.area_m2, 1, 1e-9);
}

TEST(SiteOutdoor, PolygonsWithoutAreaAreCountedAndLeftOut) {
    FeatureSet set;
    add_polygon(set, Role::building, box_ring(0, 0, 10, 10));
    add_polygon(set, Role::building, {{20, 20}, {25, 20}});
    const Site site = build_site(set, {}, "line").site;
    EXPECT_EQ(site.counts.dropped_invalid, 1);
    EXPECT_EQ(site.walls.size(), 4U);
}

TEST(SiteOutdoor, HoleOutsideItsRing) {
    FeatureSet set;
    add_polygon(set, Role::building, box_ring(0, 0, 10, 10), {box_ring(20, 20, 22, 22)});
    const std::string message = message_of([&] { build_site(set, {}, "hole"); });
    EXPECT_NE(message.find("feature 1"), std::string::npos) << message;
    EXPECT_NE(message.find("ole lies outside"), std::string::npos) << message;
}

TEST(SiteOutdoor, LargeCoordinatesGiveTheSameWalls) {
    const std::vector<Ring> rings = {{{0.1, 0.2}, {10.35, 0.7}, {9.871, 8.123}, {0.3, 7.9}},
                                     box_ring(10.1, 3.3, 18.7, 9.9)};
    const Site here = town(rings);
    const Vec2d far(500000, 5400000);
    std::vector<Ring> moved = rings;
    for (Ring& ring : moved) {
        for (Vec2d& p : ring) p += far;
    }
    const Site there = town(moved);
    EXPECT_EQ(here.origin, Vec2d(0, 0));  // whole metres below the south-west corner
    EXPECT_EQ(there.origin, far);
    ASSERT_EQ(there.walls.size(), here.walls.size());
    for (std::size_t i = 0; i < here.walls.size(); ++i) {
        EXPECT_EQ(there.walls[i].a, here.walls[i].a);
        EXPECT_EQ(there.walls[i].b, here.walls[i].b);
        EXPECT_EQ(there.walls[i].free_side[left], here.walls[i].free_side[left]);
    }
}

TEST(SiteOutdoor, OrderOfFeaturesDoesNotMatter) {
    const std::vector<Ring> rings = {box_ring(0, 0, 10, 10), box_ring(5, 2, 15, 12),
                                     box_ring(15, 0, 20, 12)};
    const Site a = town(rings);
    const Site b = town({rings[2], rings[0], rings[1]});
    ASSERT_EQ(a.walls.size(), b.walls.size());
    for (std::size_t i = 0; i < a.walls.size(); ++i) {
        EXPECT_EQ(a.walls[i].a, b.walls[i].a);
        EXPECT_EQ(a.walls[i].b, b.walls[i].b);
    }
}

TEST(SiteOutdoor, CropKeepsWholeFeaturesByTheirCentre) {
    SiteOptions options;
    options.crop_m = {0, 0, 50, 50};
    const std::vector<Ring> rings = {box_ring(40, 0, 58, 10), box_ring(45, 20, 57, 30)};
    const Site site = town(rings, options);
    EXPECT_EQ(site.buildings, 1);
    EXPECT_EQ(site.counts.outside_crop, 1);
    EXPECT_DOUBLE_EQ(total_length(site), 56);
    options.crop_m = {500, 500, 600, 600};
    EXPECT_NE(message_of([&] { town(rings, options); }).find("crop_m"), std::string::npos);
}

TEST(SiteOutdoor, NoBuildingsIsAnError) {
    EXPECT_NE(message_of([] { build_site({}, {}, "nothing.shp"); }).find("nothing.shp"),
              std::string::npos);
}

std::string geojson(const std::string& ring) {
    return R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},)"
           R"("geometry":{"type":"Polygon","coordinates":[[)" +
           ring + "]]}}]}";
}

TEST(SiteFile, DegreesAreRefusedAndProjectedWhenAsked) {
    const test::TemporaryFile file(
        "degrees.geojson",
        geojson("[-80.06,40.49],[-80.0599,40.49],[-80.0599,40.4901],[-80.06,40.4901],"
                "[-80.06,40.49]"));
    const std::string message = message_of([&] { read_site(file.path(), {}); });
    EXPECT_NE(message.find("degrees"), std::string::npos) << message;
    EXPECT_NE(message.find("site.crs"), std::string::npos) << message;
    SiteOptions utm;
    utm.crs = "utm";
    const Site site = read_site(file.path(), utm).site;
    // One ten-thousandth of a degree: 11.10 m of latitude, 8.48 m of longitude at 40.49 north.
    EXPECT_NEAR(total_length(site), 2 * (11.10 + 8.48), 0.05);
    EXPECT_NE(site.crs_wkt.find("32617"), std::string::npos);
    EXPECT_GT(site.origin.y(), 4.4e6);
}

TEST(SiteFile, NotANumberIsRefused) {
    for (const char* bad : {"NaN", "1e999"}) {
        const test::TemporaryFile file(
            "nan.geojson", geojson("[0,0],[10,0],[10," + std::string(bad) + "],[0,10],[0,0]"));
        const std::string message = message_of([&] { read_site(file.path(), {}); });
        EXPECT_NE(message.find("nan.geojson"), std::string::npos) << message;
        EXPECT_NE(message.find("feature 1: a coordinate is no number"), std::string::npos)
            << message;
    }
}

TEST(SiteFile, MissingEmptyAndForeignFiles) {
    EXPECT_THROW(read_site("no_such_file.geojson", {}), IoError);
    const test::TemporaryFile empty("empty.geojson", "");
    EXPECT_THROW(read_site(empty.path(), {}), InputError);
    const test::TemporaryFile foreign("foreign.geojson", "this is no geometry");
    EXPECT_THROW(read_site(foreign.path(), {}), InputError);
}

TEST(SiteFile, TownOfBellevue) {
    VFPLAN_NEED_DATA("town_bellevue/bellevue_976x893.geojson");
    const Site site =
        read_site(test::data_dir() / "town_bellevue/bellevue_976x893.geojson", {}).site;
    EXPECT_EQ(site.buildings, 636);
    EXPECT_NEAR(site.area_m2, 636 * 125, 636);
    EXPECT_LE(site.walls.size(), 2925U);
    EXPECT_GT(site.walls.size(), 2700U);
    expect_one_free_side(site);
}

}  // namespace
}  // namespace vfplan
