// Robots' maps, traced.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tests/io/formats/files.h"

namespace vfplan {
namespace {

using test::area_m2;
using test::expect_words;
using test::indoor;
using test::is_free;
using test::TemporaryFolder;
using test::total_length;

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

}  // namespace
}  // namespace vfplan
