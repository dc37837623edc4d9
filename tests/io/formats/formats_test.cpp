// Formats of plans and cities, by small files made by hand.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/formats/read_features.h"
#include "kernels/error.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

using nlohmann::json;
using test::indoor;
using test::is_free;
using test::TemporaryFile;
using test::TemporaryFolder;
using test::total_length;
using test::wall_through;

double area_m2(const Polygon& p) {
    const auto of = [](const Ring& r) {
        double sum = 0;
        for (std::size_t i = 0; i < r.size(); ++i) sum += cross(r[i], r[(i + 1) % r.size()]);
        return std::abs(sum) / 2;
    };
    double sum = of(p.outer);
    for (const Ring& hole : p.holes) sum -= of(hole);
    return sum;
}

std::string message_of(const std::string& name, const std::string& text,
                       const ReadOptions& options = {}) {
    const TemporaryFile file(name, text);
    try {
        read_features(file.path(), options);
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Exit::input);
        return e.what();
    }
    return "no error";
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
    for (const std::string& w : words) {
        EXPECT_NE(text.find(w), std::string::npos) << "no \"" << w << "\" in: " << text;
    }
}

// --- CityJSON -----------------------------------------------------------------------------------

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
    expect_words(message_of("corner.json", city.dump()),
                 {"/CityObjects/house/geometry/0/boundaries/0/0/0/2", "0 to 17", "1000"});
    city = house(true);
    city["vertices"][3][1] = "north";
    expect_words(message_of("vertex.json", city.dump()), {"/vertices/3/1", "number", "string"});
}

// --- Sweet Home 3D ------------------------------------------------------------------------------

// A room of 6 x 4 m inside walls of 20 cm, joined at its corners, with a door and a window.
std::string home(const std::string& more = "", const std::string& level = "") {
    const double x[] = {-10, 610, 610, -10};
    const double y[] = {-10, -10, 410, 410};
    std::string out = "<?xml version='1.0'?>\n<home version='7000' wallHeight='250'>\n";
    const std::string on = level.empty() ? "" : " level='" + level + "'";
    if (!level.empty()) {
        out += "<level id='g' name='ground'/><level id='u' name='upper'/>\n";
    }
    for (int i = 0; i < 4; ++i) {
        out += fmt::format(
            "<wall id='w{}' wallAtStart='w{}' wallAtEnd='w{}' xStart='{}' yStart='{}' xEnd='{}' "
            "yEnd='{}' height='250' thickness='20'{}/>\n",
            i, (i + 3) % 4, (i + 1) % 4, x[i], y[i], x[(i + 1) % 4], y[(i + 1) % 4], on);
    }
    out += fmt::format(
        "<room name='den'{}><point x='0' y='0'/><point x='600' y='0'/>"
        "<point x='600' y='400'/><point x='0' y='400'/></room>\n",
        on);
    out += fmt::format(
        "<doorOrWindow catalogId='eTeks#door' name='Front' x='300' y='-10' width='90' depth='20' "
        "wallThickness='1' wallDistance='0'{}><sash xAxis='0.5'/></doorOrWindow>\n"
        "<doorOrWindow catalogId='eTeks#window' name='View' x='610' y='200' angle='1.5707964' "
        "width='120' depth='30' wallThickness='0.6' wallDistance='0.2'{}/>\n"
        "<pieceOfFurniture name='sofa' x='100' y='300' width='180' depth='80' angle='0'{}/>\n",
        on, on, on);
    return out + more + "</home>\n";
}

TEST(Formats, SweetHomeDoorsOpenTheirWalls) {
    const TemporaryFile file("Home.xml", home());
    const SiteResult open = read_site(file.path(), indoor());
    // Inside 20 m less the door, its two sides of 0.2 m; outside 21.6 m less the door.
    EXPECT_NEAR(total_length(open.site), 20 + 21.6 - 2 * 0.9 + 2 * 0.2, 1e-6);
    EXPECT_NEAR(open.site.area_m2, 24 + 0.9 * 0.2, 1e-6);
    EXPECT_TRUE(is_free(open.site, {3, 0.1}));  // y is turned: the door lies above
    const Wall* side = wall_through(open.site, {2.55, 0.1});
    ASSERT_NE(side, nullptr);
    EXPECT_EQ(side->cls, WallClass::wall);
    const Wall* window = wall_through(open.site, {6, -2});
    ASSERT_NE(window, nullptr);
    EXPECT_EQ(window->cls, WallClass::window);
    EXPECT_NEAR(window->length_m(), 1.2, 1e-6);

    SiteOptions closed = indoor();
    closed.doors = DoorMode::closed;
    const Site shut = read_site(file.path(), closed).site;
    EXPECT_NEAR(total_length(shut), 20 + 21.6, 1e-6);
    EXPECT_FALSE(is_free(shut, {3, 0.1}));

    SiteOptions aired = indoor();
    aired.windows = WindowMode::opening;
    EXPECT_NEAR(total_length(read_site(file.path(), aired).site),
                20 + 21.6 - 2 * 0.9 - 2 * 1.2 + 4 * 0.2, 1e-6);

    SiteOptions furnished = indoor();
    furnished.roles = {{"furniture*", Role::obstacle}};
    EXPECT_FALSE(is_free(read_site(file.path(), furnished).site, {1, -3}));
    EXPECT_TRUE(is_free(open.site, {1, -3}));
}

TEST(Formats, SweetHomeLevelsAndRoundWalls) {
    const std::string two = home("", "u");
    expect_words(message_of("levels.xml", two, indoor()), {"2 levels", "ground, upper"});
    SiteOptions upper = indoor();
    upper.layer = "upper";
    const TemporaryFile levels("levels2.xml", two);
    EXPECT_EQ(read_features(levels.path(), upper).features.size(), 4U + 1 + 2);
    upper.layer = "roof";
    expect_words(message_of("levels3.xml", two, upper), {"no level 'roof'", "ground, upper"});

    // Half a ring of 2 m radius and 10 cm thickness.
    const TemporaryFile round("round.xml",
                              home("<wall id='r' xStart='0' yStart='1000' xEnd='400' yEnd='1000' "
                                   "thickness='10' arcExtent='3.1415927'/>\n"));
    double area = 0;
    Box box;
    for (const Feature& f : read_features(round.path(), indoor()).features) {
        if (f.id != "r") continue;
        area = area_m2(f.polygons.at(0));
        box = bounds(f);
    }
    EXPECT_NEAR(area, M_PI * 2 * 0.1, 0.005);
    EXPECT_NEAR(box.size().x(), 4.1, 0.01);
    EXPECT_NEAR(box.size().y(), 2.05, 0.01);
}

TEST(Formats, SweetHomeSaysWhereItIsWrong) {
    std::string broken = home();
    broken.replace(broken.find("thickness='20'"), 14, "thickness='NaN'");
    expect_words(message_of("nan.xml", broken, indoor()), {"nan.xml:3:", "<wall>", "thickness"});
    expect_words(message_of("cut.xml", home().substr(0, 700), indoor()), {"cut.xml:", "damaged"});
}

// --- Structured3D -------------------------------------------------------------------------------

// Two rooms of 4 x 3 m with 0.2 m between them, a door of 0.9 m there, a window outside; turned by
// an angle; in millimetres.
json annotation(double turn) {
    json out = {{"junctions", json::array()}, {"lines", json::array()},
                {"planes", json::array()},    {"semantics", json::array()},
                {"cuboids", json::array()},   {"manhattan", json::array()}};
    std::vector<std::pair<int, int>> ends;
    std::vector<std::vector<int>> lines_of;
    const auto junction = [&](double x, double y, double z) {
        out["junctions"].push_back({{"ID", out["junctions"].size()},
                                    {"coordinate",
                                     {x * std::cos(turn) - y * std::sin(turn),
                                      x * std::sin(turn) + y * std::cos(turn), z}}});
        return static_cast<int>(out["junctions"].size()) - 1;
    };
    const auto plane = [&](const std::string& type, const std::vector<int>& ring) {
        lines_of.emplace_back();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            lines_of.back().push_back(static_cast<int>(ends.size()));
            ends.emplace_back(ring[i], ring[(i + 1) % ring.size()]);
        }
        out["planes"].push_back({{"ID", out["planes"].size()}, {"type", type}, {"offset", 0}});
        return static_cast<int>(out["planes"].size()) - 1;
    };
    const auto semantic = [&](const std::string& type, const std::vector<int>& planes) {
        out["semantics"].push_back({{"type", type}, {"planeID", planes}});
    };
    const auto room = [&](const std::string& type, double x0) {
        const std::vector<int> floor = {junction(x0, 0, 0), junction(x0 + 4000, 0, 0),
                                        junction(x0 + 4000, 3000, 0), junction(x0, 3000, 0)};
        semantic(type, {plane("floor", {floor[2], floor[3], floor[0], floor[1]})});
    };
    const auto upright = [&](double x0, double y0, double x1, double y1, double z) {
        return plane("wall", {junction(x0, y0, z), junction(x1, y1, z), junction(x1, y1, z + 2000),
                              junction(x0, y0, z + 2000)});
    };
    room("living room", 0);
    room("bedroom", 4200);
    semantic("door", {upright(4000, 1000, 4000, 1900, 0), upright(4200, 1000, 4200, 1900, 0)});
    semantic("window", {upright(1000, 3000, 2200, 3000, 900)});
    semantic("outwall", {0});
    json lj = json::array();
    json pl = json::array();
    const auto row = [](std::size_t n, const std::vector<int>& ones) {
        std::vector<int> r(n, 0);
        for (const int i : ones) r[static_cast<std::size_t>(i)] = 1;
        return r;
    };
    for (const auto& [a, b] : ends) {
        lj.push_back(row(out["junctions"].size(), {a, b}));
        out["lines"].push_back({{"point", {0, 0, 0}}, {"direction", {1, 0, 0}}});
    }
    for (const auto& lines : lines_of) pl.push_back(row(ends.size(), lines));
    out["lineJunctionMatrix"] = lj;
    out["planeLineMatrix"] = pl;
    return out;
}

TEST(Formats, Structured3dRoomsAreJoinedByTheirDoor) {
    for (const double turn : {0.0, 0.5}) {
        const TemporaryFile file("annotation_3d.json", annotation(turn).dump());
        const SiteResult read = read_site(file.path(), indoor());
        EXPECT_EQ(read.how.format, "Structured3D");
        EXPECT_NEAR(total_length(read.site), 2 * 14 - 2 * 0.9, 0.05) << turn;
        EXPECT_NEAR(read.site.area_m2, 2 * 12 + 0.9 * 0.2, 0.05) << turn;
        const auto at = [&](double x, double y) {
            return Vec2d(x * std::cos(turn) - y * std::sin(turn),
                         x * std::sin(turn) + y * std::cos(turn));
        };
        EXPECT_TRUE(is_free(read.site, at(4.1, 1.45))) << turn;
        EXPECT_FALSE(is_free(read.site, at(4.1, 0.5))) << turn;
        double window_m = 0;
        for (const Wall& w : read.site.walls) {
            if (w.cls == WallClass::window) window_m += w.length_m();
        }
        EXPECT_NEAR(window_m, 1.2, 0.005) << turn;
    }
    json broken = annotation(0);
    broken["planeLineMatrix"][0][0] = 0;
    expect_words(message_of("annotation_3d.json", broken.dump(), indoor()),
                 {"/planes/0", "make no ring"});
}

// --- Robots' maps -------------------------------------------------------------------------------

struct RosMap {
    TemporaryFolder folder{"ros-map-test"};

    // A room of 8 x 5 m inside walls of 0.2 m, free; unknown around; a speck on the floor.
    explicit RosMap(const std::string& yaml, int scale = 1) {
        std::string pixels = fmt::format("P5\n{} {}\n255\n", 200 * scale, 140 * scale);
        for (int y = 139; y >= 0; --y) {
            std::string row;
            for (int x = 0; x < 200; ++x) {
                const auto in = [&](int x0, int y0, int x1, int y1) {
                    return x >= x0 && x < x1 && y >= y0 && y < y1;
                };
                const bool floor = in(20, 20, 180, 120);
                const bool wall = !floor && in(16, 16, 184, 124);
                const char grey = wall || (x == 50 && y == 50) ? '\x00' : floor ? '\xFE' : '\xCD';
                row.append(static_cast<std::size_t>(scale), grey);
            }
            for (int k = 0; k < scale; ++k) pixels += row;
        }
        test::write_bytes(folder.path() / "map.pgm", pixels);
        test::write_bytes(folder.path() / "map.yaml", yaml);
    }
    std::filesystem::path yaml() const { return folder.path() / "map.yaml"; }
};

constexpr const char* ros_yaml =
    "image: map.pgm\nresolution: 0.050000\norigin: [-10.0, 5.0, 0.0]\nnegate: 0\n"
    "occupied_thresh: 0.65\nfree_thresh: 0.196\n";

TEST(Formats, RosMapIsTraced) {
    const RosMap map(ros_yaml);
    const SiteResult read = read_site(map.yaml(), indoor());
    EXPECT_EQ(read.how.format, "ROS map");
    EXPECT_NEAR(read.site.area_m2, 8 * 5, 0.2);
    EXPECT_NEAR(total_length(read.site), 2 * (8 + 5) + 2 * (8.4 + 5.4), 0.5);
    EXPECT_TRUE(is_free(read.site, {-10 + 2, 5 + 2}));
    EXPECT_FALSE(is_free(read.site, {-10 + 0.5, 5 + 0.5}));
    ASSERT_EQ(read.warnings.size(), 1U);
    expect_words(read.warnings[0], {"2 specks"});  // in the floor a hole, in the walls an island
    double faces_m = 0;
    for (const Wall& w : read.site.walls) {
        faces_m += (w.free_side[left] + w.free_side[right]) * w.length_m();
    }
    EXPECT_NEAR(faces_m, 2 * (8 + 5), 0.3);
}

TEST(Formats, RosMapTurnedAndNegated) {
    std::string yaml = ros_yaml;
    yaml.replace(yaml.find("0.0]"), 4, "1.5707963267948966]");
    const RosMap map(yaml);
    const Site site = read_site(map.yaml(), indoor()).site;
    EXPECT_TRUE(is_free(site, {-10 - 2, 5 + 8}));
    EXPECT_NEAR(site.extent.size().y(), 8.4, 0.1);
    yaml.replace(yaml.find("negate: 0"), 9, "negate: 1");
    const RosMap negated(yaml);  // the walls are free, 2 cells wide, and the floor a pillar
    const FeatureSet set = read_features(negated.yaml(), indoor());
    double wall_m2 = 0;
    for (const Feature& f : set.features) {
        if (f.role == Role::wall) wall_m2 += area_m2(f.polygons.at(0));
    }
    EXPECT_GT(wall_m2, 8 * 5);
}

TEST(Formats, RosMapSaysWhatIsWrong) {
    const auto wrong = [](const std::string& yaml) {
        const RosMap map(yaml);
        try {
            read_features(map.yaml(), indoor());
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string("no error");
    };
    std::string yaml = ros_yaml;
    yaml.replace(yaml.find("0.050000"), 8, "fine");
    expect_words(wrong(yaml), {"map.yaml:2", "resolution is no number"});
    yaml = ros_yaml;
    yaml.replace(yaml.find("map.pgm"), 7, "gone.pgm");
    expect_words(wrong(yaml), {"gone.pgm", "no such image"});
    expect_words(wrong(std::string(ros_yaml) + "mode: raw\n"), {"map.yaml:7", "raw"});
    expect_words(wrong(std::string(ros_yaml) + "a: [1, {b: 2\n"), {"map.yaml:"});
}

// --- Drawings -----------------------------------------------------------------------------------

TEST(Formats, DxfBlocksAndSplinesThroughPoints) {
    const auto groups = [](std::initializer_list<std::pair<int, std::string>> list) {
        std::string out;
        for (const auto& [code, value] : list) out += fmt::format("{:3d}\r\n{}\r\n", code, value);
        return out;
    };
    const std::string dxf =
        groups({{0, "SECTION"}, {2, "HEADER"}, {9, "$INSUNITS"}, {70, "6"}, {0, "ENDSEC"}}) +
        groups({{0, "SECTION"},
                {2, "BLOCKS"},
                {0, "BLOCK"},
                {8, "0"},
                {2, "COL"},
                {70, "0"},
                {10, "0"},
                {20, "0"},
                {3, "COL"},
                {0, "LINE"},
                {8, "WALL"},
                {10, "0"},
                {20, "0"},
                {11, "1"},
                {21, "0"},
                {0, "ENDBLK"},
                {8, "0"},
                {0, "ENDSEC"}}) +
        groups({{0, "SECTION"},
                {2, "ENTITIES"},
                {0, "INSERT"},
                {8, "WALL"},
                {2, "COL"},
                {10, "5"},
                {20, "5"},
                {41, "2"},
                {50, "90"},
                // A quarter of a circle of 4 m by five points.
                {0, "SPLINE"},
                {8, "WALL"},
                {100, "AcDbSpline"},
                {70, "8"},
                {71, "3"},
                {74, "5"},
                {11, "4"},
                {21, "0"},
                {11, "3.69551813"},
                {21, "1.53073373"},
                {11, "2.82842712"},
                {21, "2.82842712"},
                {11, "1.53073373"},
                {21, "3.69551813"},
                {11, "0"},
                {21, "4"},
                {0, "LINE"},
                {8, "WALL"},
                {10, "0"},
                {20, "4"},
                {11, "0"},
                {21, "0"},
                {0, "LINE"},
                {8, "WALL"},
                {10, "0"},
                {20, "0"},
                {11, "4"},
                {21, "0"},
                {0, "ENDSEC"},
                {0, "EOF"}});
    const TemporaryFile file("curves.dxf", dxf);
    const FeatureSet set = read_features(file.path(), indoor());
    double on_circle = 0;
    bool inserted = false;
    for (const Feature& f : set.features) {
        EXPECT_EQ(f.role, Role::wall);
        for (const Line& line : f.lines) {
            if (line.size() > 10) {
                for (const Vec2d& v : line) on_circle = std::max(on_circle, std::abs(v.norm() - 4));
                EXPECT_EQ(line.size(), 4U * 16 + 1);
            }
            if ((line.front() - Vec2d(5, 5)).norm() < 1e-9) {
                inserted = (line.back() - Vec2d(5, 7)).norm() < 1e-9;
            }
        }
    }
    EXPECT_TRUE(inserted);
    EXPECT_GT(on_circle, 0);
    EXPECT_LT(on_circle, 0.01);
    EXPECT_NEAR(read_site(file.path(), indoor()).site.area_m2, M_PI * 4, 0.05);
}

TEST(Formats, WhatIsNoSiteIsNamed) {
    expect_words(message_of("model.ifc", "ISO-10303-21;\nHEADER;\n"), {"IFC", "IfcConvert"});
    expect_words(message_of("plan.dwg", "AC1032\x01\x02"), {"DWG", "DXF"});
    expect_words(message_of("plan.pdf", "%PDF-1.7\n"), {"PDF"});
    expect_words(message_of("poem.txt", "once upon a time"), {"not a site", "docs/formats.md"});
    ReadOptions where;
    where.where = "a = 1";
    const TemporaryFile pol("g.pol", "3 0/1 0/1 1/1 0/1 0/1 1/1\n");
    EXPECT_THROW(read_features(pol.path(), where), UsageError);
    where.where.clear();
    where.layer = "walls";
    EXPECT_THROW(read_features(pol.path(), where), InputError);
}

}  // namespace
}  // namespace vfplan
