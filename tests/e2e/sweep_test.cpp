// Plans side by side, through the built program.
#include <fmt/format.h>

#include "program.h"

namespace vfplan::test {
namespace {

class Sweep : public ::testing::Test {
protected:
    Sweep() {
        generated(scratch, "town");
        sets = {"site.input=" + scratch / "town.geojson", "site.crop_m=[0,0,400,292]",
                "field.cell_m=2", "output.formats=['csv']"};
    }
    // Each with its plan: the plan's stations.
    std::string stations(const std::string& dir) {
        return read_bytes(scratch / (dir + "/stations.csv"));
    }
    std::vector<std::string> with(const std::vector<std::string>& more) const {
        std::vector<std::string> all = sets;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Output sweep(const std::vector<std::string>& more) {
        return vfplan_expect(
            0,
            with_sets({"sweep", config_file("town.toml"), "--out", scratch / "all"}, with(more)));
    }

    Scratch scratch;
    std::vector<std::string> sets;
};

TEST_F(Sweep, PlansWhatRunPlansAndSetsItSideBySide) {
    const Output out = sweep({"overlap.threshold=0.3,0.5", "plan.method=greedy,refined"});
    const auto [header, rows] = read_csv(scratch / "all/sweep.csv");
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(header[0], "plan");
    EXPECT_EQ(header[1], "overlap.threshold");
    EXPECT_EQ(header[2], "plan.method");
    EXPECT_EQ(header[3], "stations");
    std::size_t row = 0;
    for (const std::string threshold : {"0.3", "0.5"}) {
        for (const std::string method : {"greedy", "refined"}) {
            const std::string name =
                fmt::format("overlap.threshold={},plan.method={}", threshold, method);
            SCOPED_TRACE(name);
            vfplan_expect(
                0, with_sets({"run", config_file("town.toml"), "--out", scratch / name, "--quiet"},
                             with({"overlap.threshold=" + threshold, "plan.method=" + method})));
            EXPECT_EQ(stations("all/" + name), stations(name));
            const Json one = read_json(scratch / (name + "/summary.json"));
            const Json other = read_json(scratch / ("all/" + name + "/summary.json"));
            EXPECT_EQ(one["result_sha256"], other["result_sha256"]);
            EXPECT_EQ(rows[row][0], name);
            EXPECT_EQ(rows[row][1], threshold);
            EXPECT_EQ(rows[row][2], method);
            EXPECT_EQ(rows[row][3], std::to_string(one["stations"].get<int>()));
            EXPECT_NE(out.out.find(name), std::string::npos);
            ++row;
        }
    }
    EXPECT_EQ(read_bytes(scratch / "all/sweep.png").substr(1, 3), "PNG");
}

TEST_F(Sweep, GoesOnWhereItStopped) {
    sweep({"plan.loops=true,false"});
    const std::string table = read_bytes(scratch / "all/plan.loops=false/stations.csv");
    ASSERT_GT(table.size(), 100U);
    std::filesystem::remove_all(scratch / "all/plan.loops=false");
    std::filesystem::remove(scratch / "all/plan.loops=true/summary.json");
    std::filesystem::remove(scratch / "all/sweep.csv");
    sweep({"plan.loops=true,false"});
    EXPECT_EQ(read_bytes(scratch / "all/plan.loops=false/stations.csv"), table);
    EXPECT_EQ(read_csv(scratch / "all/sweep.csv").rows.size(), 2U);
}

TEST_F(Sweep, SaysAWrongValueBeforeItBegins) {
    const Output out =
        vfplan_expect(2, with_sets({"sweep", config_file("town.toml"), "--out", scratch / "all"},
                                   with({"overlap.threshold=0.3,1.5"})));
    EXPECT_NE(out.err.find("overlap.threshold"), std::string::npos) << out.err;
    EXPECT_FALSE(std::filesystem::exists(scratch / "all"));
}

TEST_F(Sweep, CompareNamesWhatDiffersAndRefusesWhatHoldsNoPlan) {
    for (const std::string dir : {"one", "two"}) {
        vfplan_expect(
            0, with_sets({"run", config_file("town.toml"), "--out", scratch / dir, "--quiet"},
                         with({dir == "one" ? "plan.loops=true" : "plan.loops=false"})));
    }
    const Output out = vfplan_expect(0, {"compare", scratch / "one", scratch / "two", "--csv",
                                         scratch / "c.csv", "--out", scratch / "c.png"});
    EXPECT_NE(out.out.find("plan.loops"), std::string::npos);
    EXPECT_EQ(out.out.find("overlap.threshold"), std::string::npos);
    EXPECT_EQ(read_csv(scratch / "c.csv").rows.size(), 2U);
    EXPECT_EQ(read_bytes(scratch / "c.png").substr(1, 3), "PNG");
    // What was set for a plan, not what the job of its folder says.
    vfplan_expect(0, {"plan", scratch / "one", "--out", scratch / "lower", "--set",
                      "overlap.threshold=0.25", "--quiet"});
    const Output lower = vfplan_expect(0, {"compare", scratch / "one", scratch / "lower"});
    EXPECT_NE(lower.out.find("0.25"), std::string::npos) << lower.out;
    vfplan_expect(2, {"plan", scratch / "one", "--out", scratch / "one"});
    std::filesystem::remove(scratch / "two/summary.json");
    const Output no = vfplan_expect(2, {"compare", scratch / "one", scratch / "two"});
    EXPECT_NE(no.err.find("holds no plan"), std::string::npos) << no.err;
    vfplan_expect(2, {"compare", scratch / "one"});
}

}  // namespace
}  // namespace vfplan::test
