// Looking at a site before anything is computed, and planning one without a job file.
#include <csignal>
#include <fstream>

#include "../words.h"
#include "program.h"

namespace vfplan::test {
namespace {

TEST(Inspect, SaysHowASiteIsReadAndDrawsIt) {
    const Scratch scratch;
    const std::string flat = generated(scratch, "flat");
    const Output o = vfplan_process({"inspect", flat, "--out", scratch / "flat.png"});
    EXPECT_EQ(o.code, 0) << o.err;
    expect_words(o.out, {"GeoJSON", "preset \"indoor\"", "room", "by word", "window", "m2 free",
                         "left out", "flat.png"});
    std::ifstream png(scratch / "flat.png", std::ios::binary);
    std::string head(8, ' ');
    png.read(head.data(), 8);
    EXPECT_EQ(head, "\x89PNG\r\n\x1a\n");
    const std::string town = generated(scratch, "town");
    const Output t = vfplan_process({"inspect", town, "--out", scratch / "town.png"});
    EXPECT_EQ(t.code, 0) << t.err;
    expect_words(t.out, {"preset \"outdoor\"", "637", "building", "solid polygons"});
}

TEST(Inspect, ASiteIsPlannedWithThePresetThatFits) {
    const Scratch scratch;
    const std::string flat = generated(scratch, "flat");
    vfplan_expect(0,
                  {"run", flat, "--out", scratch / "out", "--set", "field.cell_m=0.1", "--quiet"});
    EXPECT_EQ(read_json(scratch / "out/summary.json")["site"]["buildings"], 6);
    vfplan_expect(0, {"verify", scratch / "out"});
    const Output no = vfplan_process({"inspect", scratch / "nowhere.geojson"});
    EXPECT_EQ(no.code, 4);
    expect_words(no.err, {"nowhere.geojson", "no such file"});
}

TEST(Inspect, APathNeedNotBeUtf8) {
    const Scratch scratch;
    const std::string folder = scratch / "caf\xe9";
    std::filesystem::create_directory(folder);
    std::filesystem::rename(generated(scratch, "flat"), folder + "/flat.geojson");
    const Words run = {"run",   folder + "/flat.geojson", "--out",  folder + "/out",
                       "--set", "field.cell_m=0.1",       "--quiet"};
    vfplan_expect(0, run);
    vfplan_expect(0, run);  // goes on where it ended
    vfplan_expect(0, {"verify", folder + "/out"});
}

// Reading a county takes seconds; a signal is heard all the same, and leaves no picture.
TEST(Inspect, ASignalEndsIt) {
    VFPLAN_NEED_DATA("city_allegheny/allegheny_north.geojson.gz");
    const Scratch scratch;
    const std::string picture = scratch / "county.png";
    for (const int signal : {SIGTERM, SIGINT}) {
        const Output o = vfplan_signalled(
            signal, 1,
            {"inspect", data_file("city_allegheny/allegheny_north.geojson.gz"), "--out", picture});
        EXPECT_EQ(o.code, 75) << o.out << o.err;
        EXPECT_FALSE(std::filesystem::exists(picture));
    }
}

// A room of 5 x 5 m, and a corridor that is too narrow for a tripod and too long for a doorway.
TEST(Inspect, NarrowGroundIsTold) {
    const Scratch scratch;
    const std::string site = scratch.write(
        "flat.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{"class":"outline"},)"
        R"("geometry":{"type":"Polygon","coordinates":[[[0,0],[5,0],[5,1],[9,1],[9,1.7],[5,1.7],)"
        R"([5,5],[0,5],[0,0]]]}}]})");
    const Output told = vfplan_process({"inspect", site, "--out", scratch / "site.png"});
    EXPECT_EQ(told.code, 0) << told.err;
    EXPECT_NE(told.out.find("of ground in 1 place where no station may stand 0.4 m from walls"),
              std::string::npos)
        << told.out;
    const Output free = vfplan_process(
        {"inspect", site, "--out", scratch / "site.png", "--set", "site.clearance_m=0"});
    EXPECT_EQ(free.out.find("narrow "), std::string::npos) << free.out;

    vfplan_expect(0, {"run", site, "--out", scratch / "run", "--quiet", "--set",
                      "field.cell_m=0.05", "--set", "output.formats=['csv']"});
    const Json summary = read_json(scratch / "run/summary.json");
    ASSERT_EQ(summary["site"]["narrow"].size(), 1u);
    EXPECT_NEAR(summary["site"]["narrow"][0]["x"].get<double>(), 7, 0.3);
    EXPECT_NEAR(summary["site"]["narrow_m2"].get<double>(), 2.7, 0.3);
}

}  // namespace
}  // namespace vfplan::test
