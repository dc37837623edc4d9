// Homes of Sweet Home 3D, by small files made by hand.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <cmath>

#include "tests/io/formats/files.h"

namespace vfplan {
namespace {

using test::area_m2;
using test::expect_words;
using test::indoor;
using test::is_free;
using test::reading_says;
using test::TemporaryFile;
using test::total_length;
using test::wall_through;

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
    expect_words(reading_says("levels.xml", two, indoor()), {"2 levels", "ground, upper"});
    SiteOptions upper = indoor();
    upper.layer = "upper";
    const TemporaryFile levels("levels2.xml", two);
    EXPECT_EQ(read_features(levels.path(), upper).features.size(), 4U + 1 + 2);
    upper.layer = "roof";
    expect_words(reading_says("levels3.xml", two, upper), {"no level 'roof'", "ground, upper"});

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
    expect_words(reading_says("nan.xml", broken, indoor()), {"nan.xml:3:", "<wall>", "thickness"});
    expect_words(reading_says("cut.xml", home().substr(0, 700), indoor()), {"cut.xml:", "damaged"});
}

}  // namespace
}  // namespace vfplan
