// What people ask of a plan beyond the defaults, and of a run that was stopped.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <sstream>

#include "engine/folder/publication.h"
#include "io/tables/plan_file.h"
#include "program.h"

namespace vfplan::test {
namespace {

class Wishes : public ::testing::Test {
protected:
    Words job(const std::string& dir, const std::vector<std::string>& more,
              const std::string& kernel = "exact") {
        if (!std::filesystem::exists(scratch / "town.geojson")) generated(scratch, "town");
        std::vector<std::string> sets = {
            "site.input=" + scratch / "town.geojson", "site.crop_m=[0,0,400,292]", "field.cell_m=4",
            "visibility.kernel=" + kernel, "output.formats=['csv','geojson']"};
        sets.insert(sets.end(), more.begin(), more.end());
        return with_sets({"run", config_file("town.toml"), "--out", scratch / dir, "--quiet"},
                         sets);
    }

    // Places of the stations of a kind; of all for "".
    std::vector<std::pair<double, double>> places(const std::string& dir, const std::string& kind) {
        std::vector<std::pair<double, double>> out;
        const Json all = read_json(scratch / (dir + "/stations.geojson"));
        for (const Json& f : all["features"]) {
            const Json& at = f["geometry"]["coordinates"];
            if (kind.empty() || f["properties"]["kind"] == kind) out.emplace_back(at[0], at[1]);
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    Scratch scratch;
};

TEST_F(Wishes, RequiredAndExistingStationsAreInThePlan) {
    vfplan_expect(
        0, job("run", {"plan.required=[[313.8,112.2],[20,20]]", "plan.existing=[[100.5,150.5]]"}));
    using Places = std::vector<std::pair<double, double>>;
    EXPECT_EQ(places("run", "required"), (Places{{20, 20}, {313.8, 112.2}}));
    EXPECT_EQ(places("run", "existing"), (Places{{100.5, 150.5}}));
    EXPECT_EQ(read_json(scratch / "run/summary.json")["networks"], 1);
    vfplan_expect(0, {"verify", scratch / "run"});

    const Output inside = vfplan_process(job("none", {"plan.required=[[345,5]]"}));
    EXPECT_EQ(inside.code, 2) << "inside a building";
    EXPECT_NE(inside.err.find("(345, 5)"), std::string::npos) << inside.err;
    EXPECT_EQ(vfplan_process(job("none", {"plan.required=[[9999,9999]]"})).code, 2);
    EXPECT_FALSE(std::filesystem::exists(scratch / "none"));
}

TEST_F(Wishes, NoStationWhereItIsForbidden) {
    const auto inside = [](const std::pair<double, double>& p) {
        return p.first > 100 && p.first < 200 && p.second > 100 && p.second < 200;
    };
    vfplan_expect(0, job("free", {}));
    const auto before = places("free", "");
    ASSERT_TRUE(std::any_of(before.begin(), before.end(), inside));
    const std::string file = scratch.write(
        "garden.geojson",
        R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},"geometry":)"
        R"({"type":"Polygon","coordinates":[[[100,100],[200,100],[200,200],[100,200],[100,100]]]}}]})");
    vfplan_expect(0, job("run", {"plan.forbidden=" + file}));
    const auto after = places("run", "");
    EXPECT_FALSE(after.empty());
    EXPECT_FALSE(std::any_of(after.begin(), after.end(), inside));
    vfplan_expect(0, {"verify", scratch / "run"});
    const Output gone = vfplan_process(job("none", {"plan.forbidden=nowhere.geojson"}));
    EXPECT_EQ(gone.code, 4);
    EXPECT_NE(gone.err.find("plan.forbidden"), std::string::npos) << gone.err;
}

// The links of a plan, by station.
std::vector<std::vector<std::size_t>> links_of(const std::string& dir, std::size_t stations) {
    std::vector<std::vector<std::size_t>> out(stations);
    std::istringstream in(read_bytes(dir + "/links.csv"));
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        std::size_t comma = 0;
        const std::size_t from = std::stoul(line, &comma);
        const std::size_t to = std::stoul(line.substr(comma + 1));
        out[from].push_back(to);
        out[to].push_back(from);
    }
    return out;
}

TEST_F(Wishes, APlanThatSurvivesStandsTheLossOfAnyStation) {
    vfplan_expect(0, job("weak", {}));
    vfplan_expect(0, job("run", {"plan.survive=1"}));
    const Json summary = read_json(scratch / "run/summary.json");
    ASSERT_EQ(summary["networks"], 1);
    const auto stations = summary["stations"].get<std::size_t>();
    EXPECT_EQ(summary["stations_loops"].get<std::size_t>() +
                  summary["plan"]["survival"]["stations"].get<std::size_t>(),
              stations);
    const auto links = links_of(scratch / "run", stations);
    std::size_t parting = 0;
    for (std::size_t lost = 0; lost < stations; ++lost) {
        std::vector<std::size_t> queue = {lost == 0 ? std::size_t{1} : 0};
        std::vector<bool> met(stations, false);
        met[queue[0]] = met[lost] = true;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const std::size_t n : links[queue[i]]) {
                if (met[n]) continue;
                met[n] = true;
                queue.push_back(n);
            }
        }
        parting += queue.size() + 1 < stations ? 1 : 0;
    }
    EXPECT_EQ(summary["articulation_stations"], parting);
    const Output good = vfplan_process({"verify", scratch / "run"});
    EXPECT_EQ(good.code, 0) << good.out;
    EXPECT_NE(good.out.find("without any one station"), std::string::npos) << good.out;
    // A plan that only says that it survives.
    PlanTable weak = read_plan(scratch / "weak/plan.h5");
    weak.survives = true;
    write_plan(scratch / "run/plan.h5", weak);
    publish_plan(scratch / "run", read_json(scratch / "run/summary.json"));
    const Output bad = vfplan_process({"verify", scratch / "run"});
    EXPECT_EQ(bad.code, 1) << bad.out;
    EXPECT_NE(bad.out.find("need not"), std::string::npos) << bad.out;
    // Whoever plans a run anew may wish for something else than its job did.
    for (const std::string wish : {"0", "1"}) {
        vfplan_expect(0, {"plan", scratch / "run", "--set", "plan.survive=" + wish, "--quiet"});
        const Output again = vfplan_process({"verify", scratch / "run"});
        EXPECT_EQ(again.code, 0) << again.out;
        EXPECT_EQ(again.out.find("without any one station") != std::string::npos, wish == "1")
            << again.out;
    }
}

TEST_F(Wishes, ShortcutsMakeWaysShorter) {
    vfplan_expect(0, job("run", {}));
    vfplan_expect(0, {"plan", scratch / "run", "--out", scratch / "short", "--set",
                      "plan.shortcuts=0.2", "--quiet"});
    const Json before = read_json(scratch / "run/summary.json");
    const Json after = read_json(scratch / "short/summary.json");
    const auto more = after["plan"]["shortcuts"].get<int>();
    EXPECT_GT(more, 0);
    EXPECT_LE(more, before["stations"].get<int>() / 5);
    EXPECT_EQ(after["stations"].get<int>(), before["stations"].get<int>() + more);
    EXPECT_EQ(after["stations_loops"], before["stations_loops"]);
    EXPECT_LT(after["wapl"].get<double>(), before["wapl"].get<double>());
    vfplan_expect(0, {"verify", scratch / "short"});
}

// What tables depend on cannot be changed by planning again, so it is refused, not ignored.
TEST_F(Wishes, PlanRefusesWhatNeedsTables) {
    vfplan_expect(0, job("run", {}));
    const auto bytes = lasting_bytes(scratch / "run");
    for (const std::string set : {"plan.required=[[20,20]]", "plan.existing=[[20,20]]",
                                  "plan.forbidden=garden.geojson", "scanner.range_max_m=50"}) {
        const Output o = vfplan_expect(2, {"plan", scratch / "run", "--set", set, "--quiet"});
        EXPECT_NE(o.err.find(set.substr(0, set.find('='))), std::string::npos) << o.err;
    }
    EXPECT_EQ(lasting_bytes(scratch / "run"), bytes);
}

// A folder holds one plan: files of the one before do not stay beside the new one.
TEST_F(Wishes, NoFilesOfThePlanBefore) {
    vfplan_expect(0, job("run", {}));
    vfplan_expect(0, {"plan", scratch / "run", "--quiet", "--set", "plan.method=greedy", "--set",
                      "plan.loops=false", "--set", "output.formats=['csv']"});
    const std::size_t stations = read_csv(scratch / "run/stations.csv").rows.size();
    if (std::filesystem::exists(scratch / "run/stations.geojson")) {
        EXPECT_EQ(places("run", "").size(), stations);
    }
}

// The candidates were placed for mean_len 0.3: what that implies can be planned again.
TEST_F(Wishes, PlanTakesOtherOverlapsAsFarAsTheCandidatesWerePlacedForThem) {
    vfplan_expect(0, job("run", {}));
    const auto plan = [&](const std::string& ratio, const std::string& threshold) {
        return Words{"plan",
                     scratch / "run",
                     "--quiet",
                     "--set",
                     "overlap.ratio=" + ratio,
                     "--set",
                     "overlap.threshold=" + threshold};
    };
    for (const auto& [ratio, threshold] :
         {std::pair("min_len", 0.3), {"mean_len", 0.25}, {"union_len", 0.17}}) {
        vfplan_expect(0, plan(ratio, fmt::format("{}", threshold)));
        for (const double o : read_csv(scratch / "run/links.csv").numbers("overlap")) {
            EXPECT_GE(o + 1e-6, threshold) << ratio;
        }
        vfplan_expect(0, {"verify", scratch / "run"});
        EXPECT_EQ(read_json(scratch / "run/summary.json")["overlap"]["ratio"], ratio);
    }
    const auto bytes = lasting_bytes(scratch / "run");
    for (const auto& [ratio, threshold] : {std::pair("min_len", "0.31"),
                                           {"mean_len", "0.4"},
                                           {"union_len", "0.2"},
                                           {"mean_ang", "0.1"}}) {
        const Output o = vfplan_expect(2, plan(ratio, threshold));
        EXPECT_NE(o.err.find("placed for mean_len 0.3"), std::string::npos) << o.err;
    }
    EXPECT_EQ(lasting_bytes(scratch / "run"), bytes);
}

class Stopped : public Wishes {};

TEST_F(Stopped, KilledRunsGoOnToTheSameBytes) {
    vfplan_expect(0, job("whole", {}, "embree"));
    for (const char* seconds : {"0.05", "0.2", "0.4", "0.6"}) {
        Words words = {"-s", "KILL", seconds, VFPLAN_BINARY};
        for (const std::string& w : job("parts", {}, "embree")) words.push_back(w);
        if (run_program("timeout", words).code == 127) GTEST_SKIP() << "no timeout here";
    }
    vfplan_expect(0, job("parts", {}, "embree"));
    expect_same_bytes(scratch / "whole", scratch / "parts");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch / "parts")) {
        EXPECT_EQ(entry.path().filename().string().find("tmp"), std::string::npos) << entry.path();
    }
}

TEST_F(Stopped, AlsoInTheMidstOfASearch) {
    vfplan_expect(0, job("run", {}));
    const auto plan = [&](const std::string& effort) {
        return Words{"plan",  scratch / "run",         "--out",  scratch / "other",
                     "--set", "plan.effort=" + effort, "--quiet"};
    };
    for (double after = 1; !std::filesystem::exists(scratch / "other/job.toml"); after *= 2) {
        const Output o = vfplan_signalled(SIGTERM, after, plan("1000000"));
        ASSERT_EQ(o.code, 75) << o.err;
    }
    EXPECT_FALSE(std::filesystem::exists(scratch / "other/summary.json"));
    // Another plan is not put where one was begun; the same one is.
    vfplan_expect(2, plan("10"));
    EXPECT_EQ(vfplan_signalled(SIGTERM, 1, plan("1000000")).code, 75);
    vfplan_expect(0, {"plan", scratch / "run", "--out", scratch / "third", "--quiet"});
    vfplan_expect(2, {"plan", scratch / "run", "--out", scratch / "third", "--quiet"});
}

// "75 stopped early, resumable": Slurm and Ctrl-C ask politely.
TEST_F(Stopped, PoliteStopsAreResumable) {
    for (const int signal : {SIGTERM, SIGINT}) {
        int code = 0;
        // Too early it does not listen yet, too late it has ended.
        for (double after = 0.1; code != 75 && after < 3; after *= 1.5) {
            const std::string dir = "run" + std::to_string(signal) + std::to_string(after);
            const Output o =
                vfplan_signalled(signal, after, job(dir, {"field.cell_m=1"}, "embree"));
            code = o.code;
            EXPECT_TRUE(code == 0 || code == 75 || code == 128 + signal) << o.err;
        }
        EXPECT_EQ(code, 75) << signal;
    }
}

}  // namespace
}  // namespace vfplan::test
