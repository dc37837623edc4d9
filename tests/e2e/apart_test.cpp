// Small plans on which networks were said to be apart that one free cell joins.
#include <fmt/format.h>

#include <array>

#include "program.h"

namespace vfplan::test {
namespace {

struct Plan {
    const char* name;
    Features features;
    const char* settings;
    std::int64_t networks;  // over all free cells
};

void PrintTo(const Plan& p, std::ostream* out) { *out << p.name; }

const std::vector<Plan>& plans() {
    static const std::vector<Plan> all = {
        {"two_screens",
         {
             {"outline", "Polygon",
              "[[[0.0,0.0],[8.414,0.0],[8.414,5.707],[0.0,5.707],[0.0,0.0]]]"},
             {"wall", "LineString", "[[2.598,1.648],[3.915,1.648]]"},
             {"wall", "LineString", "[[2.598,1.653],[3.915,1.653]]"},
             {"wall", "LineString", "[[2.976,0.0],[2.976,3.402]]"},
             {"wall", "LineString", "[[2.976,4.399],[2.976,5.707]]"},
             {"wall", "LineString", "[[3.752,4.846],[2.689,0.955]]"},
         },
         R"(range_min_m = 0.6
range_max_m = 6.0
max_incidence_deg = 75.0
[field]
cell_m = 0.5
threshold_rad = 1.0
[coverage]
partition_m = 5.0
visible_fraction = 0.5
[overlap]
ratio = "mean_ang"
threshold = 0.3
[site]
clearance_m = 0.3
doors = "closed"
windows = "wall"
)",
         1},
        {"two_rooms",
         {
             {"wall", "Polygon",
              "[[[999.86,-0.14],[1005.32,-0.14],[1005.32,10.24],[999.86,10.24],[999.86,-0.14]],[["
              "1000.0,0.0],[1005.18,0.0],[1005.18,10.1],[1000.0,10.1],[1000.0,0.0]]]"},
             {"wall", "LineString", "[[1000.0,9.23],[1003.75,9.23]]"},
             {"wall", "LineString", "[[1004.67,9.23],[1005.18,9.23]]"},
         },
         R"(range_min_m = 0.3
range_max_m = 3.0
[field]
cell_m = 0.5
threshold_rad = 1.0
[coverage]
partition_m = 5.0
visible_fraction = 0.5
[overlap]
ratio = "min_len"
threshold = 0.4
[site]
clearance_m = 0.0
doors = "open"
windows = "opening"
)",
         1},
        {"closet",
         {
             {"wall", "Polygon",
              "[[[999.85,-0.15],[1009.0,-0.15],[1009.0,10.8],[999.85,10.8],[999.85,-0.15]],[[1000."
              "0,0.0],[1008.85,0.0],[1008.85,10.65],[1000.0,10.65],[1000.0,0.0]]]"},
             {"wall", "LineString", "[[1003.3,0.0],[1003.3,8.65]]"},
             {"door", "LineString", "[[1003.3,8.65],[1003.3,9.55]]"},
             {"wall", "LineString", "[[1003.3,9.55],[1003.3,10.65]]"},
             {"wall", "LineString", "[[1002.15,4.7],[1004.6,4.7]]"},
             {"wall", "LineString", "[[1002.15,4.7001],[1004.6,4.7001]]"},
             {"wall", "LineString", "[[1000.65,2.95],[1001.75,2.95]]"},
             {"wall", "LineString", "[[1000.65,2.9501],[1001.75,2.9501]]"},
             {"wall", "LineString", "[[1002.45,0.0],[1002.45,8.5]]"},
             {"wall", "LineString", "[[1002.45,9.15],[1002.45,10.65]]"},
         },
         R"(range_min_m = 1.2
range_max_m = 12.0
[field]
cell_m = 0.3
threshold_rad = 1.0
[coverage]
partition_m = 0.5
visible_fraction = 0.1
[overlap]
ratio = "mean_len"
threshold = 0.3
[site]
clearance_m = 0.3
doors = "open"
windows = "opening"
)",
         2},
    };
    return all;
}

class Apart : public ::testing::TestWithParam<Plan> {};

TEST_P(Apart, NoMoreNetworksThanOverAllFreeCells) {
    const Scratch scratch;
    scratch.write("plan.geojson", geojson(GetParam().features));
    const std::string job = scratch.write(
        "job.toml", fmt::format("preset = \"indoor\"\n[output]\nformats = [\"csv\"]\n[scanner]\n{}"
                                "input = \"plan.geojson\"\n",
                                GetParam().settings));
    const auto run = [&](const char* name, const char* side, const char* threads) {
        vfplan_expect(0, {"run", job, "--out", scratch / name, "--quiet", "--threads", threads,
                          "--set", std::string("field.tile_cells=") + side});
        return Path(scratch / name);
    };
    const Path one = run("one", "1024", "1");
    const auto summary = read_json(one / "summary.json");
    EXPECT_EQ(summary["networks"], GetParam().networks);
    vfplan_expect(0, {"verify", one});
    // Tiles and threads change nothing.
    const Path other = run("other", "64", "2");
    EXPECT_EQ(summary["result_sha256"], read_json(other / "summary.json")["result_sha256"]);
    EXPECT_EQ(read_bytes(one / "coverage.h5"), read_bytes(other / "coverage.h5"));
    if (GetParam().networks < 2) {
        EXPECT_FALSE(summary.contains("joins_main_at_over"));
        return;
    }
    // A closet that walls close all round: proven, over every free cell.
    EXPECT_EQ(summary["network_list"][1]["joins_main_at"], 0.0);
    EXPECT_EQ(summary["joins_main_at_over"],
              fmt::format("all {} free cells", summary["grid"]["free_cells"].get<int>()));
    const Output text = vfplan_expect(0, {"run", job, "--out", scratch / "text"});
    EXPECT_NE(text.out.find("no chain of the"), std::string::npos) << text.out;
    // Asked for another ratio than the tables were made for, nothing is said of free cells.
    vfplan_expect(0, {"plan", other, "--set", "overlap.ratio=min_len", "--quiet"});
    EXPECT_EQ(read_json(other / "summary.json")["joins_main_at_over"], "candidates");
}

INSTANTIATE_TEST_SUITE_P(Plans, Apart, ::testing::ValuesIn(plans()),
                         [](const auto& i) { return std::string(i.param.name); });

}  // namespace
}  // namespace vfplan::test
