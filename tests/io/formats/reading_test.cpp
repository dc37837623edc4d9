// What is read from files of many makes: roles, units, places on earth.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "io/formats/read_features.h"
#include "kernels/error.h"
#include "tests/io/site/features.h"
#include "tests/words.h"

namespace vfplan {
namespace {

using test::expect_words;
using test::message_of;
using test::TemporaryFile;

std::string geojson(const std::vector<std::string>& features, const std::string& head = "") {
    std::string out = R"({"type":"FeatureCollection",)" + head + R"("features":[)";
    for (std::size_t i = 0; i < features.size(); ++i) out += (i > 0 ? "," : "") + features[i];
    return out + "]}";
}

std::string square(const std::string& properties, double x, double y, double side) {
    return fmt::format(
        R"({{"type":"Feature","properties":{{{}}},"geometry":{{"type":"Polygon","coordinates":[[[{},{}],[{},{}],[{},{}],[{},{}],[{},{}]]]}}}})",
        properties, x, y, x + side, y, x + side, y + side, x, y + side, x, y);
}

std::vector<Role> roles(const FeatureSet& set) {
    std::vector<Role> out;
    for (const Feature& f : set.features) out.push_back(f.role);
    return out;
}

TEST(Reading, AStreetIsNoTreeAndRulesDecideFirst) {
    const TemporaryFile file("roles.geojson", geojson({square(R"("type":"Streetfront")", 0, 0, 10),
                                                       square(R"("class":"tree")", 20, 0, 10),
                                                       square(R"("layer":"A-DEMO")", 40, 0, 10)}));
    EXPECT_EQ(roles(read_features(file.path(), {})),
              (std::vector{Role::building, Role::obstacle, Role::building}));
    ReadOptions options;
    options.roles = {{"a-*", Role::ignored}, {"tree", Role::building}};
    EXPECT_EQ(roles(read_features(file.path(), options)),
              (std::vector{Role::building, Role::building, Role::ignored}));
}

TEST(Reading, OutdoorsABoundaryIsNoBuilding) {
    const TemporaryFile file(
        "boundary.geojson", geojson({square(R"("type":"boundary","building":null)", 0, 0, 100),
                                     square(R"("type":"multipolygon","building":"yes")", 20, 0, 10),
                                     square(R"("building":"no")", 40, 0, 10)}));
    const FeatureSet set = read_features(file.path(), {});
    EXPECT_EQ(roles(set), std::vector{Role::building});
    EXPECT_EQ(set.ignored, 2);
    const TemporaryFile untagged("untagged.geojson",
                                 geojson({square(R"("type":"boundary")", 0, 0, 100),
                                          square(R"("type":"house")", 20, 0, 10)}));
    EXPECT_EQ(roles(read_features(untagged.path(), {})), std::vector{Role::building});
}

TEST(Reading, WhereFilters) {
    const TemporaryFile file("where.geojson", geojson({square(R"("height":3)", 0, 0, 10),
                                                       square(R"("height":8)", 20, 0, 10)}));
    ReadOptions options;
    options.where = "height > 5";
    EXPECT_EQ(read_features(file.path(), options).features.size(), 1U);
    options.where = "heigth > 5";
    expect_words(message_of<UsageError>([&] { read_features(file.path(), options); }),
                 {"site.where", "heigth"});
}

// A small extract: a building, one with a court as a relation, a municipality, a fence.
constexpr const char* osm = R"(<?xml version="1.0"?><osm version="0.6">
<node id="1" lat="60.0000" lon="25.0000"/><node id="2" lat="60.0000" lon="25.0004"/>
<node id="3" lat="60.0002" lon="25.0004"/><node id="4" lat="60.0002" lon="25.0000"/>
<node id="5" lat="60.00005" lon="25.0001"/><node id="6" lat="60.00005" lon="25.0003"/>
<node id="7" lat="60.00015" lon="25.0003"/><node id="8" lat="60.00015" lon="25.0001"/>
<node id="11" lat="59.9990" lon="24.9990"/><node id="12" lat="59.9990" lon="25.0030"/>
<node id="13" lat="60.0030" lon="25.0030"/><node id="14" lat="60.0030" lon="24.9990"/>
<node id="21" lat="60.0010" lon="25.0000"/><node id="22" lat="60.0010" lon="25.0003"/>
<node id="23" lat="60.0012" lon="25.0003"/>
<way id="101"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/></way>
<way id="102"><nd ref="5"/><nd ref="6"/><nd ref="7"/><nd ref="8"/><nd ref="5"/></way>
<way id="103"><nd ref="11"/><nd ref="12"/><nd ref="13"/><nd ref="14"/><nd ref="11"/></way>
<way id="104"><nd ref="21"/><nd ref="22"/><nd ref="23"/><nd ref="21"/><tag k="building" v="yes"/></way>
<way id="105"><nd ref="21"/><nd ref="14"/><tag k="barrier" v="fence"/></way>
<relation id="201"><member type="way" ref="101" role="outer"/><member type="way" ref="102" role="inner"/>
<tag k="type" v="multipolygon"/><tag k="building" v="apartments"/></relation>
<relation id="202"><member type="way" ref="103" role="outer"/><tag k="type" v="boundary"/>
<tag k="boundary" v="administrative"/><tag k="admin_level" v="8"/></relation>
</osm>)";

TEST(Reading, OfOpenStreetMapOnlyBuildings) {
    const TemporaryFile file("town.osm", osm);
    const FeatureSet set = read_features(file.path(), {});
    ASSERT_EQ(set.features.size(), 2U);
    std::size_t courts = 0;
    for (const Feature& f : set.features) {
        EXPECT_EQ(f.role, Role::building);
        for (const Polygon& p : f.polygons) courts += p.holes.size();
    }
    EXPECT_EQ(courts, 1U);
    EXPECT_NE(set.crs_wkt.find("UTM zone 35N"), std::string::npos);
    ReadOptions options;
    options.osm_barriers = true;
    const FeatureSet fenced = read_features(file.path(), options);
    ASSERT_EQ(fenced.features.size(), 3U);
    EXPECT_EQ(fenced.features.back().role, Role::wall);
    EXPECT_EQ(fenced.features.back().lines.size(), 1U);
}

// A room of 8 x 6 m as a drawing, in a unit.
std::string dxf(double per_m, int insunits, const std::string& layer = "WALL") {
    std::string out = "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n";
    if (insunits >= 0) out += fmt::format("9\n$INSUNITS\n70\n{:6d}\n", insunits);
    out += "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
    const double x[] = {0, 8, 8, 0, 0};
    const double y[] = {0, 0, 6, 6, 0};
    for (int i = 0; i < 4; ++i) {
        out += fmt::format("0\nLINE\n8\n{}\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", layer, x[i] * per_m,
                           y[i] * per_m, x[i + 1] * per_m, y[i + 1] * per_m);
    }
    return out + "0\nENDSEC\n0\nEOF\n";
}

ReadOptions indoor() {
    ReadOptions options;
    options.kind = SiteKind::indoor;
    return options;
}

double width_m(const FeatureSet& set) {
    Box box;
    for (const Feature& f : set.features) each_point(f, [&](const Vec2d& v) { box.add(v); });
    return box.size().x();
}

TEST(Reading, ADrawingSaysItsUnit) {
    const struct {
        double per_m;
        int insunits;
    } drawings[] = {{1000, 4}, {100, 5}, {1 / 0.0254, 1}, {1, 6}, {1, -1}, {1, 0}};
    for (const auto& [per_m, insunits] : drawings) {
        const TemporaryFile file("room.dxf", dxf(per_m, insunits));
        EXPECT_NEAR(width_m(read_features(file.path(), indoor())), 8, 1e-9) << insunits;
    }
}

TEST(Reading, AUnitThatCannotBeIsAsked) {
    const TemporaryFile silent("room.dxf", dxf(1000, -1));
    expect_words(message_of<InputError>([&] { read_features(silent.path(), indoor()); }),
                 {"8000 x 6000 m", "millimetres (8 x 6 m)", "centimetres (80 x 60 m)",
                  "site.unit_m = 0.001"});
    const TemporaryFile centimetres("cm.dxf", dxf(100, -1));
    expect_words(message_of<InputError>([&] { read_features(centimetres.path(), indoor()); }),
                 {"800 x 600 m", "centimetres (8 x 6 m)", "0.01"});
    const TemporaryFile inches("inches.dxf", dxf(1 / 0.0254, -1));
    expect_words(message_of<InputError>([&] { read_features(inches.path(), indoor()); }),
                 {"315 x 236 m", "inches (8 x 6 m)", "0.0254"});
    const TemporaryFile wrong("wrong.dxf", dxf(1 / 0.0254, 4));
    expect_words(message_of<InputError>([&] { read_features(wrong.path(), indoor()); }),
                 {"$INSUNITS = 4", "inches", "site.unit_m = 0.0254"});
    ReadOptions options = indoor();
    options.unit_m = 0.0254;
    EXPECT_NEAR(width_m(read_features(wrong.path(), options)), 8, 1e-9);
    options.unit_m = 1;  // really
    EXPECT_NEAR(width_m(read_features(silent.path(), options)), 8000, 1e-9);
}

TEST(Reading, WallsOnLayerZeroStayBesideALayerOfDoors) {
    std::string text = dxf(1, 6, "0");
    text.insert(text.rfind("0\nENDSEC"), "0\nLINE\n8\nA-DOOR\n10\n2\n20\n0\n11\n3\n21\n0\n");
    const TemporaryFile file("doors.dxf", text);
    const std::vector<Role> got = roles(read_features(file.path(), indoor()));
    EXPECT_EQ(std::count(got.begin(), got.end(), Role::wall), 4);
    EXPECT_EQ(std::count(got.begin(), got.end(), Role::door), 1);
    ReadOptions options = indoor();
    options.layer = "a-door";  // one door is no building, in any unit
    EXPECT_EQ(roles(read_features(file.path(), options)), std::vector{Role::door});
}

TEST(Reading, MetricCoordinatesMayBeDeclared) {
    const TemporaryFile file("metres.geojson", geojson({square("", 500000, 5500000, 20)}));
    EXPECT_EQ(read_features(file.path(), {}).crs_wkt, "");
    ReadOptions options;
    options.crs = "EPSG:32633";
    const FeatureSet set = read_features(file.path(), options);
    EXPECT_NE(set.crs_wkt.find("UTM zone 33N"), std::string::npos);
    EXPECT_EQ(set.features[0].polygons[0].outer[0].x(), 500000);
    options.crs = "utm";
    expect_words(message_of<InputError>([&] { read_features(file.path(), options); }),
                 {"does not say where"});
    options.crs = "EPSG:4326";
    expect_words(message_of<UsageError>([&] { read_features(file.path(), options); }),
                 {"in degrees", "utm"});
    options.crs = "EPSG:2272";  // Pennsylvania South, feet
    expect_words(message_of<UsageError>([&] { read_features(file.path(), options); }), {"foot"});
}

TEST(Reading, PlacesInDegreesAreUnderstood) {
    const TemporaryFile file("degrees.geojson", geojson({square("", 25.0, 60.0, 0.0002),
                                                         square("", 25.001, 60.0, 0.0002)}));
    SiteOptions options;
    options.crs = "utm";
    const SiteResult whole = read_site(file.path(), options);
    EXPECT_EQ(whole.site.buildings, 2);
    options.points = {{25.0005, 60.0001}};
    options.crop_m = {24.9999, 59.9999, 25.0005, 60.0005};
    const SiteResult part = read_site(file.path(), options);
    EXPECT_EQ(part.site.buildings, 1);
    ASSERT_EQ(part.points.size(), 1U);
    // 0.0005 degrees east of the first corner at 60 degrees north: 27.9 m, and 11.1 m north.
    const FeatureSet set = read_features(file.path(), options);
    const Vec2d corner = set.features[0].polygons[0].outer[0];
    EXPECT_NEAR(part.points[0].x() - corner.x(), 27.9, 1);
    EXPECT_NEAR(part.points[0].y() - corner.y(), 11.1, 1);
    // The same in the zone's metres.
    options.points = {part.points[0]};
    EXPECT_EQ(read_site(file.path(), options).points[0], part.points[0]);
}

// --- strays --------------------------------------------------------------------------------------

TEST(Strays, AreNamedWithTheCropThatLeavesThemOut) {
    FeatureSet set;
    for (const double x : {0, 30, 60}) {
        test::add_polygon(set, Role::building, test::box_ring(x, 0, x + 10, 10));
    }
    test::add_polygon(set, Role::building, test::box_ring(5e4, 7e4, 5e4 + 10, 7e4 + 10));
    set.features.back().id = "w77";
    SiteOptions options;
    const SiteResult r = build_site(set, options, "town");
    ASSERT_EQ(r.warnings.size(), 1U);
    expect_words(r.warnings[0], {"feature 4, id w77 at (50005.00, 70005.00)", "50 km x 70 km",
                                 "70 m x 10 m", "site.crop_m = [0, 0, 70, 10]"});
    options.crop_m = {0, 0, 70, 10};
    const SiteResult without = build_site(set, options, "town");
    EXPECT_TRUE(without.warnings.empty());
    EXPECT_EQ(without.site.buildings, 3);
}

TEST(Strays, RoomsAndLabelsMakeNoSiteLarger) {
    FeatureSet set;
    test::add_line(set, Role::wall, {{0, 0}, {5, 0}, {5, 4}, {0, 4}, {0, 0}});
    test::add_polygon(set, Role::room, test::box_ring(0, 0, 5, 4));
    test::add_line(set, Role::ignored, {{9000, 0}, {9001, 0}});
    test::add_polygon(set, Role::room, test::box_ring(9000, 0, 9005, 4));
    SiteOptions options;
    options.kind = SiteKind::indoor;
    EXPECT_TRUE(build_site(set, options, "flat").warnings.empty());
}

// A floor plan of 5 m with a stroke 3 km off is no plan in inches.
TEST(Strays, SayNothingOfTheUnit) {
    const auto line = [](const std::string& coordinates) {
        return R"({"type":"Feature","properties":{"class":"wall"},"geometry":{"type":"LineString",)"
               R"("coordinates":[)" +
               coordinates + "]}}";
    };
    const TemporaryFile file("stray.geojson",
                             geojson({line("[0,0],[5,0]"), line("[5,0],[5,4]"), line("[5,4],[0,4]"),
                                      line("[0,4],[0,0]"), line("[3000,3000],[3000.1,3000]")}));
    SiteOptions options;
    options.kind = SiteKind::indoor;
    EXPECT_EQ(read_features(file.path(), options).features.size(), 5U);
}

}  // namespace
}  // namespace vfplan
