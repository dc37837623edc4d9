// From a generated site to a verified plan, over every command of the road.
#include <algorithm>
#include <cmath>

#include "program.h"

namespace vfplan::test {
namespace {

const Words files = {"job.toml",    "summary.json", "provenance.json", "field.h5",
                     "coverage.h5", "plan.h5",      "stations.csv",    "stations.geojson",
                     "links.csv",   "pieces.csv",   "map.png"};

// The south-west of a generated town, or a generated flat, in cells coarse enough for seconds.
Words job(const Scratch& scratch, const std::string& kind, const std::string& command,
          const std::string& dir, const std::vector<std::string>& more = {}) {
    std::vector<std::string> sets = {"site.input=" + scratch / (kind + ".geojson")};
    if (kind == "town") {
        sets.insert(sets.end(), {"site.crop_m=[0,0,520,292]", "field.cell_m=4"});
    } else {
        sets.emplace_back("field.cell_m=0.1");
    }
    sets.insert(sets.end(), more.begin(), more.end());
    return with_sets({command, config_file(kind + ".toml"), "--out", scratch / dir, "--quiet"},
                     sets);
}

void expect_whole(const Path& dir) {
    for (const std::string& name : files) EXPECT_TRUE(std::filesystem::exists(dir / name)) << name;
    const Json s = read_json(dir / "summary.json");
    for (const char* key : {"site",
                            "grid",
                            "candidates",
                            "pieces",
                            "pieces_coverable",
                            "pieces_covered",
                            "length_coverable_m",
                            "length_covered_m",
                            "stations",
                            "networks",
                            "links",
                            "wapl",
                            "bottleneck_overlap",
                            "bridges",
                            "articulation_stations",
                            "lower_bound",
                            "gap",
                            "kernel",
                            "stage_wall_s",
                            "stage_cpu_s",
                            "wall_s",
                            "peak_rss_mb",
                            "result_sha256"}) {
        EXPECT_TRUE(s.contains(key)) << key;
    }
    EXPECT_EQ(s["result_sha256"].get<std::string>().size(), 64U);
    EXPECT_LE(s["lower_bound"], s["stations"]);
    const auto connected = s["stations_connected"].get<double>();
    const auto bound = s["bound_connected"].get<double>();
    EXPECT_LE(bound, connected);
    EXPECT_DOUBLE_EQ(s["gap_connected"].get<double>(), (connected - bound) / connected);
    EXPECT_EQ(s["gap"], s["gap_connected"]);
    EXPECT_GE(s["stations_loops"].get<double>(), connected);
    EXPECT_LE(s["bound_loops"], s["stations_loops"]);
    EXPECT_FALSE(s.contains("gap_loops"));  // its bound is one without loops
    EXPECT_EQ(s["candidate_pool"]["name"], "pool");
    EXPECT_EQ(s["candidate_pool"]["candidates"], s["candidates"]);
}

void expect_tables_agree(const Path& dir) {
    const Json s = read_json(dir / "summary.json");
    const Csv stations = read_csv(dir / "stations.csv");
    const Csv links = read_csv(dir / "links.csv");
    const Csv pieces = read_csv(dir / "pieces.csv");
    EXPECT_EQ(stations.rows.size(), s["stations"].get<std::size_t>());
    EXPECT_EQ(links.rows.size(), s["links"].get<std::size_t>());
    EXPECT_EQ(pieces.rows.size(), s["pieces"].get<std::size_t>());
    EXPECT_EQ(stations.counts("component").size(), s["networks"].get<std::size_t>());
    auto status = pieces.counts("status");
    EXPECT_EQ(status["covered"], s["pieces_covered"].get<std::int64_t>());
    EXPECT_EQ(status["unreached"], s["pieces_unreached"].get<std::int64_t>());
    EXPECT_EQ(
        status["covered"] + status["unreached"] + status["no_viewpoint"] + status["off_candidates"],
        s["pieces"].get<std::int64_t>());
    EXPECT_GE(s["pieces_coverable"], s["pieces_covered"]);

    const auto lengths = pieces.numbers("length_m");
    const auto states = pieces.column("status");
    double covered = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        if (states[i] == "covered") covered += lengths[i];
    }
    EXPECT_NEAR(covered, s["length_covered_m"].get<double>(),
                1e-4 * static_cast<double>(lengths.size()));

    const auto component = stations.numbers("component");
    const auto from = links.numbers("from");
    const auto to = links.numbers("to");
    const auto overlap = links.numbers("overlap");
    for (std::size_t i = 0; i < from.size(); ++i) {
        ASSERT_LT(from[i], to[i]);
        ASSERT_LT(to[i], static_cast<double>(component.size()));
        EXPECT_EQ(component[static_cast<std::size_t>(from[i])],
                  component[static_cast<std::size_t>(to[i])]);
        EXPECT_GE(overlap[i] + 1e-6, s["overlap"]["threshold"].get<double>());
    }
}

// Points of stations.geojson and stations.csv are one; they lie among the input's coordinates,
// and pieces lie on the input's edges.
void expect_places(const Path& dir, const std::vector<double>& box) {
    const Csv stations = read_csv(dir / "stations.csv");
    const auto x = stations.numbers("x");
    const auto y = stations.numbers("y");
    const Json geo = read_json(dir / "stations.geojson");
    EXPECT_EQ(geo["type"], "FeatureCollection");
    ASSERT_EQ(geo["features"].size(), x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        const Json& at = geo["features"][i]["geometry"]["coordinates"];
        EXPECT_NEAR(at[0].get<double>(), x[i], 1e-9);
        EXPECT_NEAR(at[1].get<double>(), y[i], 1e-9);
        EXPECT_TRUE(x[i] >= box[0] && x[i] <= box[2] && y[i] >= box[1] && y[i] <= box[3])
            << "station " << i << " at " << x[i] << ", " << y[i];
    }
    const Csv pieces = read_csv(dir / "pieces.csv");
    const auto x0 = pieces.numbers("x0");
    const auto y0 = pieces.numbers("y0");
    const auto x1 = pieces.numbers("x1");
    const auto y1 = pieces.numbers("y1");
    const auto length = pieces.numbers("length_m");
    for (std::size_t i = 0; i < x0.size(); ++i) {
        EXPECT_NEAR(std::hypot(x1[i] - x0[i], y1[i] - y0[i]), length[i], 3e-4);
    }
}

class Road : public ::testing::TestWithParam<const char*> {};

TEST_P(Road, RunLeavesFilesThatAgree) {
    const Scratch scratch;
    const std::string kind = GetParam();
    generated(scratch, kind);
    vfplan_expect(0, job(scratch, kind, "run", "run"));
    const Path dir = scratch / "run";
    expect_whole(dir);
    expect_tables_agree(dir);
    expect_places(dir, kind == "town" ? std::vector<double>{-30, -30, 550, 322}
                                      : std::vector<double>{-1, -1, 11, 12});
    EXPECT_EQ(read_bytes(dir / "map.png").substr(0, 8), "\x89PNG\r\n\x1a\n");
    const Output verified = vfplan_expect(0, {"verify", dir});
    EXPECT_NE(verified.out.find("yes: the plan holds"), std::string::npos) << verified.out;

    // The resolved job file is a job of its own, with the same result.
    vfplan_expect(0, {"run", dir / "job.toml", "--out", scratch / "again", "--quiet"});
    expect_same_bytes(dir, scratch / "again");
}

TEST_P(Road, PrecomputeAndPlanIsRun) {
    const Scratch scratch;
    const std::string kind = GetParam();
    const std::string site = generated(scratch, kind);
    vfplan_expect(0, job(scratch, kind, "run", "whole"));
    vfplan_expect(0, job(scratch, kind, "precompute", "parts"));
    EXPECT_FALSE(std::filesystem::exists(scratch / "parts/plan.h5"));
    std::filesystem::remove(site);
    vfplan_expect(0, {"plan", scratch / "parts", "--quiet"});
    const Json whole = read_json(scratch / "whole/summary.json");
    const Json parts = read_json(scratch / "parts/summary.json");
    EXPECT_EQ(parts["result_sha256"], whole["result_sha256"]);
    expect_same_bytes(scratch / "whole", scratch / "parts");

    const Words other = {"plan.method=greedy", "plan.loops=false"};
    vfplan_expect(0, with_sets({"plan", scratch / "parts", "--quiet"}, other));
    const Json greedy = read_json(scratch / "parts/summary.json");
    EXPECT_NE(greedy["result_sha256"], whole["result_sha256"]);
    EXPECT_NE(read_bytes(scratch / "parts/stations.csv"),
              read_bytes(scratch / "whole/stations.csv"));
    vfplan_expect(0, {"verify", scratch / "parts"});
    expect_tables_agree(scratch / "parts");
    const Output refused =
        vfplan_expect(2, {"plan", scratch / "parts", "--set", "field.cell_m=8", "--quiet"});
    EXPECT_NE(refused.err.find("field.cell_m"), std::string::npos) << refused.err;
    vfplan_expect(0, {"plan", scratch / "parts", "--quiet"});
    expect_same_bytes(scratch / "whole", scratch / "parts");
}

INSTANTIATE_TEST_SUITE_P(Sites, Road, ::testing::Values("town", "flat"),
                         [](const auto& i) { return std::string(i.param); });

TEST(RoadTest, DryRunWritesNothing) {
    const Scratch scratch;
    generated(scratch, "town");
    const auto before = scratch.names();
    Words words = job(scratch, "town", "run", "run");
    words.emplace_back("--dry-run");
    words.erase(std::find(words.begin(), words.end(), "--quiet"));
    const Output o = vfplan_expect(0, words);
    EXPECT_EQ(scratch.names(), before);
    for (const char* word : {"cells", "memory", "disk", "candidates", "pieces"}) {
        EXPECT_NE(o.out.find(word), std::string::npos) << word << " not in\n" << o.out;
    }
}

TEST(RoadTest, SecondRunUsesTheTables) {
    const Scratch scratch;
    generated(scratch, "town");
    const Words words = job(scratch, "town", "run", "run");
    vfplan_expect(0, words);
    const auto bytes = lasting_bytes(scratch / "run");
    const auto written = std::filesystem::last_write_time(scratch / "run/field.h5");
    vfplan_expect(0, words);
    EXPECT_EQ(lasting_bytes(scratch / "run"), bytes);
    EXPECT_EQ(std::filesystem::last_write_time(scratch / "run/field.h5"), written);
    EXPECT_FALSE(read_json(scratch / "run/summary.json")["stage_wall_s"].contains("field"));

    Words fresh = words;
    fresh.emplace_back("--fresh");
    vfplan_expect(0, fresh);
    EXPECT_EQ(lasting_bytes(scratch / "run"), bytes);
    EXPECT_NE(std::filesystem::last_write_time(scratch / "run/field.h5"), written);

    // A table that lost its end is made again.
    std::filesystem::resize_file(scratch / "run/field.h5", 20000);
    vfplan_expect(0, words);
    EXPECT_EQ(lasting_bytes(scratch / "run"), bytes);
}

}  // namespace
}  // namespace vfplan::test
