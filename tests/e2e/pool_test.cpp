// Candidates off the ridges, through the built program.
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <set>

#include "engine/tables/scenes.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "kernels/overlap_rows.h"
#include "program.h"

namespace vfplan::test {
namespace {

class Pool : public ::testing::Test {
protected:
    // Runs a generated site; gives its summary.
    Json run(const std::string& kind, const std::string& dir, std::vector<std::string> sets) {
        if (!std::filesystem::exists(scratch / (kind + ".geojson"))) generated(scratch, kind);
        sets.push_back("site.input=" + scratch / (kind + ".geojson"));
        sets.push_back("output.formats=['csv','certificate']");
        vfplan_expect(
            0, with_sets({"run", config_file(kind + ".toml"), "--out", scratch / dir, "--quiet"},
                         sets));
        return summary(dir);
    }
    Json summary(const std::string& dir) { return read_json(scratch / (dir + "/summary.json")); }

    Scratch scratch;
};

const std::vector<std::string> town = {"site.crop_m=[0,0,400,292]", "field.cell_m=2"};
const std::vector<std::string> flat = {"field.cell_m=0.1"};

std::vector<std::string> with(std::vector<std::string> sets, const std::string& more) {
    sets.push_back(more);
    return sets;
}

TEST_F(Pool, HasPointsWhereStationsMayStandAndTheirRows) {
    for (const auto& [kind, sets] : {std::pair("town", town), {"flat", flat}}) {
        SCOPED_TRACE(kind);
        const Json s = run(kind, kind, sets);
        const Path dir = scratch / kind;
        const Candidates axis = read_candidates(dir, CandidatePool::axis);
        const Candidates all = read_candidates(dir, CandidatePool::pool);
        const CoverageTables& t = all.tables;
        EXPECT_EQ(s["candidate_pool"]["name"], "pool");
        EXPECT_EQ(s["candidate_pool"]["candidates"], t.rows());
        ASSERT_GT(t.rows(), axis.tables.rows());
        const FieldFile field(dir / "field.h5");
        const Grid& grid = field.info().layout.grid;
        const Raster<float> vf = field.read({0, 0, grid.nx, grid.ny});
        std::set<std::int64_t> cells;
        for (const Candidate& c : t.candidates) {
            const bool fresh = c.cell < 0 || cells.insert(c.cell).second;
            EXPECT_TRUE(fresh) << c.cell;
        }
        // The scanner's views from there, made anew.
        SceneOptions options;
        const bool outdoors = kind == std::string("town");
        options.scanner = outdoors ? Scanner{0.6, 600, 90} : Scanner{0.6, 30, 90};
        options.partition_m = outdoors ? 5 : 0.1;
        const NearWalls near =
            near_walls(field.info().layout, t.walls,
                       wall_reach_m(options.scanner.range_max_m, options.partition_m, 0.001));
        Scenes scenes(
            field.info().layout,
            [&](std::int64_t patch) { return patch_site(t.walls, t.pieces, near, patch); }, options,
            8);
        for (std::int64_t i = axis.tables.rows(); i < t.rows(); ++i) {
            const Candidate& c = t.candidates[idx(i)];
            ASSERT_EQ(c.kind, CandidateKind::pool);
            EXPECT_EQ(c.at, grid.centre(c.cell));
            EXPECT_EQ(c.vf_rad, vf[idx(c.cell)]);  // not NaN, so a station may stand there
            const std::int64_t from = t.begin[idx(i)];
            const std::int64_t count = t.begin[idx(i) + 1] - from;
            const auto pieces = all.entries.pieces(from, count);
            const auto angles = all.entries.angles_rad(from, count);
            const CoverageRow row = scenes.look(c.at).row;
            ASSERT_EQ(row.size(), pieces.size());
            for (std::size_t k = 0; k < row.size(); ++k) {
                ASSERT_EQ(row[k].piece, pieces[k]);
                ASSERT_EQ(row[k].angle_rad, angles[k]);
            }
        }
    }
}

TEST_F(Pool, NeedsNoMoreStationsAndIsMadeByPlanAsByRun) {
    for (const auto& [kind, sets] : {std::pair("town", town), {"flat", flat}}) {
        SCOPED_TRACE(kind);
        // Without loops: with more candidates more stations could be on a cycle, and have to.
        const std::vector<std::string> open = with(sets, "plan.loops=false");
        const Json pool = run(kind, "pool", open);
        const Json axis = run(kind, "axis", with(open, "plan.candidates=axis"));
        EXPECT_LE(pool["stations"], axis["stations"]);
        EXPECT_TRUE(kind == std::string("flat") || pool["stations"] < axis["stations"]);
        EXPECT_FALSE(std::filesystem::exists(scratch / "axis/pool.h5"));
        EXPECT_EQ(axis["candidate_pool"]["name"], "axis");
        vfplan_expect(0, {"verify", scratch / "pool"});
        vfplan_expect(0, {"plan", scratch / "axis", "--set", "plan.candidates=pool", "--quiet"});
        EXPECT_EQ(summary("axis")["result_sha256"], pool["result_sha256"]);
        EXPECT_FALSE(std::filesystem::exists(scratch / "axis/work"));
        // A pool by other parameters is another one.
        vfplan_expect(0, {"plan", scratch / "axis", "--set", "plan.pool_taken=1", "--set",
                          "plan.candidates=pool", "--quiet"});
        EXPECT_NE(summary("axis")["result_sha256"], pool["result_sha256"]);
        for (const char* dir : {"pool", "axis"}) std::filesystem::remove_all(scratch / dir);
    }
}

TEST_F(Pool, PlanOutLeavesTheFolderAsItIsAndWritesOverNothing) {
    run("flat", "flat", with(flat, "plan.candidates=axis"));
    const auto bytes = [&] {
        std::map<Path, std::string> out;
        for (const auto& e : std::filesystem::recursive_directory_iterator(scratch / "flat")) {
            if (e.is_regular_file()) out[e.path()] = read_bytes(e.path());
        }
        return out;
    };
    const auto before = bytes();
    const Words again = {"plan",   scratch / "flat",   "--out", scratch / "two",
                         "--set",  "plan.loops=false", "--set", "plan.candidates=pool",
                         "--quiet"};
    vfplan_expect(0, again);
    EXPECT_TRUE(bytes() == before);
    vfplan_expect(0, {"verify", scratch / "two"});
    const Json whole = run("flat", "whole", with(flat, "plan.loops=false"));
    EXPECT_EQ(summary("two")["result_sha256"], whole["result_sha256"]);
    // Complete by itself, and the same job as one that was run.
    std::filesystem::remove_all(scratch / "flat");
    EXPECT_EQ(run("flat", "two", with(flat, "plan.loops=false"))["result_sha256"],
              whole["result_sha256"]);
    vfplan_expect(0, {"plan", scratch / "two", "--quiet"});
    EXPECT_EQ(summary("two")["result_sha256"], whole["result_sha256"]);
    const Output refused = vfplan_process({"plan", scratch / "whole", "--out", scratch / "two"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("writes over none"), std::string::npos) << refused.err;
    EXPECT_EQ(vfplan_process({"plan", scratch / "two", "--out", scratch / "two"}).code, 2);
}

// A room with ten slits, as deep as two pieces, that all aim at one point off the ridges: nowhere
// else does one see into more than one of them.
TEST_F(Pool, FindsTheOnePointThatSeesAll) {
    const Vec2d point(5.05, 2.55);
    std::string ring = "[0,0],[10,0],[10,5]";
    for (int k = 9; k >= 0; --k) {
        const Vec2d mouth(0.8 + 0.93 * k, 5);
        const Vec2d deep = mouth + 0.4 * (mouth - point).normalized();
        for (const auto& [at, side] : {std::pair(mouth, 1), {deep, 1}, {deep, -1}, {mouth, -1}}) {
            ring += fmt::format(",[{},{}]", at.x() + 0.06 * side, at.y());
        }
    }
    ring += ",[0,5],[0,0]";
    std::ofstream(scratch / "slits.geojson")
        << fmt::format(R"({{"type":"FeatureCollection","features":[{{"type":"Feature",)"
                       R"("properties":{{"class":"outline"}},"geometry":{{"type":"Polygon",)"
                       R"("coordinates":[[{}]]}}}}]}})",
                       ring);
    const auto stations = [&](const std::string& pool) {
        vfplan_expect(
            0, with_sets({"run", config_file("flat.toml"), "--out", scratch / pool, "--quiet"},
                         {"site.input=" + scratch / "slits.geojson", "field.cell_m=0.1",
                          "plan.candidates=" + pool, "output.formats=['certificate']"}));
        vfplan_expect(0, {"verify", scratch / pool});
        return summary(pool)["stations"].get<int>();
    };
    EXPECT_GT(stations("axis"), 1);
    EXPECT_EQ(stations("pool"), 1);
}

}  // namespace
}  // namespace vfplan::test
