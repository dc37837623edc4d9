// Houses of Structured3D, by small files made by hand.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/io/formats/files.h"

namespace vfplan {
namespace {

using nlohmann::json;
using test::expect_words;
using test::indoor;
using test::is_free;
using test::reading_says;
using test::TemporaryFile;
using test::total_length;

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
    expect_words(reading_says("annotation_3d.json", broken.dump(), indoor()),
                 {"/planes/0", "make no ring"});
}

}  // namespace
}  // namespace vfplan
