// Verify's second reading of a site finds what cleaning might have lost.
#include "engine/job/reread.h"

#include <gtest/gtest.h>

#include "io/site/site_reader.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

constexpr const char* town = R"({"type":"FeatureCollection","features":[
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[0,0],[10,0],[10,8],[0,8],[0,0]]]}},
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[5,4],[15,4],[15,12],[5,12],[5,4]]]}},
{"type":"Feature","properties":{"class":"wall"},"geometry":{"type":"LineString","coordinates":[[-5,2],[20,2]]}}]})";

class RereadTest : public ::testing::Test {
protected:
    RereadTest() : file("reread.geojson", town) {
        config.site.input = file.path();
        Site site = read_site(file.path(), ground_options(config).site).site;
        tables.origin = site.origin;
        tables.summary = R"({"site":{"area_m2":140.0}})";
        tables.walls = std::move(site.walls);
    }
    bool good() const { return reread(config, tables, nullptr).good; }
    test::TemporaryFile file;
    Config config;
    CoverageTables tables;
};

TEST_F(RereadTest, WhatIsDrawnIsThere) {
    const Reread r = reread(config, tables, nullptr);
    EXPECT_TRUE(r.good);
    ASSERT_EQ(r.text.size(), 4U);
    // Two rings in one of 2 x (15 + 12) m, and 5 + 10 m of fence beside it.
    EXPECT_NE(r.text[0].find("69.00 m of walls, 69.00 m in the tables"), std::string::npos)
        << r.text[0];
    EXPECT_NE(r.text[1].find("54.00 m with one free side, 15.00 m with two"), std::string::npos)
        << r.text[1];
    EXPECT_NE(r.text[2].find("140.00 m2 are built over"), std::string::npos) << r.text[2];
}

TEST_F(RereadTest, AnotherAreaIsSeen) {
    tables.summary = R"({"site":{"area_m2":140.2}})";
    EXPECT_FALSE(good());
}

TEST_F(RereadTest, AFreeSideLessIsSeen) {
    for (Wall& w : tables.walls) {
        for (const Side side : {left, right}) {
            if (!w.free_side[side]) continue;
            w.free_side[side] = false;
            EXPECT_FALSE(good());
            w.free_side[side] = true;
        }
    }
    EXPECT_TRUE(good());
}

TEST_F(RereadTest, AWallLessIsSeen) {
    for (std::size_t i = 0; i < tables.walls.size(); ++i) {
        const Wall lost = tables.walls[i];
        tables.walls.erase(tables.walls.begin() + static_cast<std::ptrdiff_t>(i));
        EXPECT_FALSE(good()) << "wall " << i;
        tables.walls.insert(tables.walls.begin() + static_cast<std::ptrdiff_t>(i), lost);
    }
    EXPECT_TRUE(good());
}

TEST_F(RereadTest, AFaceIntoASolidIsSeen) {
    for (Wall& w : tables.walls) {
        for (const Side side : {left, right}) {
            if (w.free_side[side]) continue;
            w.free_side[side] = true;
            EXPECT_FALSE(good());
            w.free_side[side] = false;
        }
    }
}

// A ring that goes 12 m out and back along a line: that is no wall to either reading.
TEST(Reread, ASpikeIsNoWall) {
    const test::TemporaryFile file("spike.geojson",
                                   R"({"type":"FeatureCollection","features":[
{"type":"Feature","properties":{},"geometry":{"type":"Polygon","coordinates":[[[0,0],[10,0],[10,8],[22,8],[10,8],[0,8],[0,0]]]}}]})");
    Config config;
    config.site.input = file.path();
    config.site.invalid = InvalidPolygons::repair;
    Site site = read_site(file.path(), ground_options(config).site).site;
    CoverageTables tables;
    tables.origin = site.origin;
    tables.summary = R"({"site":{"area_m2":80.0}})";
    tables.walls = std::move(site.walls);
    const Reread r = reread(config, tables, nullptr);
    EXPECT_TRUE(r.good) << r.text[0];
    EXPECT_NE(r.text[0].find("36.00 m of walls, 36.00 m in the tables"), std::string::npos)
        << r.text[0];
}

}  // namespace
}  // namespace vfplan
