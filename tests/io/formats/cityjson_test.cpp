// Footprints of buildings from CityJSON, by small files made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/io/formats/files.h"

namespace vfplan {
namespace {

using nlohmann::json;
using test::area_m2;
using test::expect_words;
using test::reading_says;
using test::TemporaryFile;

// A house of 10 x 8 m with a court of 2 x 2 m and eaves of 1 m: corners in decimetres.
json house(bool named) {
    const auto ring = [](int x0, int y0, int x1, int y1, int z) {
        return json{{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
    };
    json vertices = json::array();
    for (const json& r : {ring(0, 0, 100, 80, 0), ring(40, 30, 60, 50, 0),
                          ring(-10, -10, 110, 90, 60), ring(40, 30, 60, 50, 60)}) {
        for (const json& v : r) vertices.push_back(v);
    }
    vertices.push_back({100, 0, 60});
    vertices.push_back({0, 0, 60});
    // The ground looks down: its outer ring is clockwise from above.
    const json ground = {{0, 3, 2, 1}, {4, 5, 6, 7}};
    const json roof = {{8, 9, 10, 11}, {12, 15, 14, 13}};
    const json wall = {{0, 1, 16, 17}};
    json geometry = {{"type", "Solid"}, {"lod", 2.2}, {"boundaries", {{ground, roof, wall}}}};
    if (named) {
        geometry["semantics"] = {
            {"surfaces",
             {{{"type", "RoofSurface"}}, {{"type", "GroundSurface"}}, {{"type", "WallSurface"}}}},
            {"values", {{1, 0, 2}}}};
    }
    return {{"type", "CityJSON"},
            {"version", "1.1"},
            {"transform", {{"scale", {0.1, 0.1, 0.1}}, {"translate", {84000, 447000, 0}}}},
            {"metadata", {{"referenceSystem", "urn:ogc:def:crs:EPSG::7415"}}},
            {"vertices", vertices},
            {"CityObjects",
             {{"house", {{"type", "Building"}, {"geometry", {geometry}}}},
              {"road", {{"type", "Road"}, {"geometry", {geometry}}}}}}};
}

TEST(Formats, CityJsonHasFootprints) {
    for (const bool named : {true, false}) {
        const TemporaryFile file("house.city.json", house(named).dump());
        const FeatureSet set = read_features(file.path(), {});
        ASSERT_EQ(set.features.size(), 1U);
        const Feature& f = set.features[0];
        EXPECT_EQ(f.id, "house");
        EXPECT_EQ(f.role, Role::building);
        ASSERT_EQ(f.polygons.size(), 1U) << named;
        EXPECT_NEAR(area_m2(f.polygons[0]), 80 - 4, 1e-6);
        EXPECT_NEAR(bounds(f).min.x(), 84000, 1e-6);
        EXPECT_NE(set.crs_wkt.find("RD New"), std::string::npos);
        EXPECT_EQ(set.how.format, "CityJSON 1.1");
    }
}

TEST(Formats, CityJsonOfTriangles) {
    json city = house(false);
    city["CityObjects"] = {
        {"hut",
         {{"type", "BuildingPart"},
          {"geometry",
           {{{"type", "MultiSurface"},
             {"lod", "1"},
             {"boundaries", {{{0, 2, 1}}, {{0, 3, 2}}, {{8, 9, 10}}, {{0, 1, 16}}}}}}}}}};
    const TemporaryFile file("triangles.json", city.dump());
    const FeatureSet set = read_features(file.path(), {});
    ASSERT_EQ(set.features.size(), 1U);
    ASSERT_EQ(set.features[0].polygons.size(), 1U);
    EXPECT_EQ(set.features[0].polygons[0].outer.size(), 4U);
    EXPECT_NEAR(area_m2(set.features[0].polygons[0]), 80, 1e-6);
}

TEST(Formats, CityJsonSaysWhereItIsWrong) {
    json city = house(true);
    city["CityObjects"]["house"]["geometry"][0]["boundaries"][0][0][0][2] = 1000;
    expect_words(reading_says("corner.json", city.dump()),
                 {"/CityObjects/house/geometry/0/boundaries/0/0/0/2", "0 to 17", "1000"});
    city = house(true);
    city["vertices"][3][1] = "north";
    expect_words(reading_says("vertex.json", city.dump()), {"/vertices/3/1", "number", "string"});
}

}  // namespace
}  // namespace vfplan
