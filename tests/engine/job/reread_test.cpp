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
        tables.walls = std::move(site.walls);
    }
    bool good() const { return reread(config, tables).good; }
    test::TemporaryFile file;
    Config config;
    CoverageTables tables;
};

TEST_F(RereadTest, WhatIsDrawnIsThere) {
    const Reread r = reread(config, tables);
    EXPECT_TRUE(r.good);
    ASSERT_EQ(r.text.size(), 2U);
    // Two rings in one of 2 x (15 + 12) m, and 5 + 10 m of fence beside it.
    EXPECT_NE(r.text[0].find("69.00 m of walls, 69.00 m in the tables"), std::string::npos)
        << r.text[0];
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

}  // namespace
}  // namespace vfplan
