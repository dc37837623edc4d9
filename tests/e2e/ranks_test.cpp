// Several processes under mpirun: each task once, and one end for all.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>

#include "program.h"

namespace vfplan::test {
namespace {

// Why a test cannot run here; empty if it can.
std::string missing_mpi() {
    if (vfplan_process({"--version"}).out.find("without MPI") != std::string::npos) {
        return "vfplan was built without MPI";
    }
    if (run_program("mpirun", {"--version"}).code != 0) return "mpirun is missing (openmpi-bin)";
    return "";
}

#define VFPLAN_NEED_MPI()                                  \
    do {                                                   \
        const std::string why = missing_mpi();             \
        if (!why.empty() && require_data()) FAIL() << why; \
        if (!why.empty()) GTEST_SKIP() << why;             \
    } while (false)

// Runs a program as `n` processes.
Output mpirun(int n, Words words, const std::string& lines = "") {
    Words all = {"-n", std::to_string(n), "--oversubscribe", "--bind-to", "none"};
    all.insert(all.end(), words.begin(), words.end());
    return run_program("mpirun", all,
                       {{"OMPI_ALLOW_RUN_AS_ROOT", "1"},
                        {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
                        // Open MPI keeps memory of plug-ins that it unloads: nobody can tell
                        // whose it was. The tests of one process look for leaks.
                        {"ASAN_OPTIONS", "detect_leaks=0"},
                        {"VFPLAN_RANKS_LINES", lines}});
}

Output ranks_main(const Words& words) {
    Words all = {VFPLAN_RANKS_MAIN};
    all.insert(all.end(), words.begin(), words.end());
    const Scratch scratch;
    const std::string lines = scratch.write("lines", "");
    Output o = mpirun(3, all, lines);
    o.out = read_bytes(lines);
    return o;
}

std::size_t count_of(const std::string& what, const std::string& text) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

// How often each task was done, and how many by each rank.
struct Tasks {
    std::map<std::int64_t, int> times;
    std::map<int, int> by_rank;
};

Tasks tasks_in(const std::string& text) {
    Tasks tasks;
    std::istringstream in(text);
    std::string word;
    std::int64_t task = 0;
    int rank = 0;
    while (in >> word) {
        if (word != "task") continue;
        in >> task >> word >> rank;
        ++tasks.times[task];
        ++tasks.by_rank[rank];
    }
    return tasks;
}

TEST(RanksUnderMpirun, EachTaskOnceAndOnAllRanks) {
    VFPLAN_NEED_MPI();
    const Scratch scratch;
    const Output o = ranks_main({"once", scratch / "meet"});
    EXPECT_EQ(o.code, 0) << o.out << o.err;
    const Tasks tasks = tasks_in(o.out);
    EXPECT_EQ(tasks.times.size(), 3U + 19 * 51 + 1) << o.out;
    for (const auto& [task, times] : tasks.times) EXPECT_EQ(times, 1) << task;
    EXPECT_EQ(tasks.by_rank.size(), 3U);
    EXPECT_EQ(count_of("end rank", o.out), 3U);
}

TEST(RanksUnderMpirun, LowestFailingTaskIsToldOnce) {
    VFPLAN_NEED_MPI();
    const Output o = ranks_main({"error"});
    EXPECT_EQ(o.code, 3) << o.err;
    EXPECT_EQ(count_of("vfplan: task 7 is bad\n", o.err), 1U) << o.err;
    EXPECT_EQ(count_of("vfplan: ", o.err), 1U) << o.err;
    EXPECT_EQ(count_of("end rank", o.out), 0U);
    EXPECT_LT(tasks_in(o.out).times.size(), 1000U);
}

TEST(RanksUnderMpirun, FailuresElsewhereEndAllRanks) {
    VFPLAN_NEED_MPI();
    const std::map<std::string, std::pair<int, std::string>> cases = {
        {"lead_error", {4, "the leader cannot write"}},
        {"outside_error", {3, "the last rank cannot go on"}},
        {"all_errors", {3, "no rank can go on"}},
        {"bug", {70, "a slip"}}};
    for (const auto& [name, end] : cases) {
        const Output o = ranks_main({name});
        EXPECT_EQ(o.code, end.first) << name << "\n" << o.err;
        EXPECT_EQ(count_of("vfplan: " + end.second, o.err), 1U) << name << "\n" << o.err;
        EXPECT_EQ(count_of("vfplan: ", o.err), 1U) << name << "\n" << o.err;
        EXPECT_EQ(count_of("end rank", o.out), 0U) << name;
    }
}

TEST(RanksUnderMpirun, SignalToOneRankStopsAll) {
    VFPLAN_NEED_MPI();
    const Scratch scratch;
    const Output o = ranks_main({"stop", scratch / "meet"});
    EXPECT_EQ(o.code, 75) << o.err;
    EXPECT_EQ(count_of("vfplan: stopped by a signal", o.err), 1U) << o.err;
    const Tasks tasks = tasks_in(o.out);
    // Every task that was handed out is done, and they were handed out in order.
    ASSERT_FALSE(tasks.times.empty());
    EXPECT_EQ(tasks.times.rbegin()->first + 1, static_cast<std::int64_t>(tasks.times.size()));
}

TEST(RanksUnderMpirun, KilledRankEndsTheJob) {
    VFPLAN_NEED_MPI();
    const Scratch scratch;
    const Output o = ranks_main({"die", scratch / "meet"});
    EXPECT_NE(o.code, 0);
    EXPECT_NE(o.err.find("signal 9"), std::string::npos) << o.err;
}

TEST(RanksUnderMpirun, WholeRunHasTheSameResult) {
    VFPLAN_NEED_MPI();
    const Scratch scratch;
    const std::string site = generated(scratch, "city", {"--size-km", "0.5"});
    const std::string job = scratch.write("job.toml", "preset = \"outdoor\"\n[site]\ninput = \"" +
                                                          site + "\"\n[field]\ncell_m = 2\n");
    vfplan_expect(0, {"run", job, "--out", scratch / "one"});
    const Output o = mpirun(3, {VFPLAN_BINARY, "run", job, "--out", scratch / "three"});
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(count_of("written to", o.out), 1U) << o.out;
    expect_same_bytes(scratch / "one", scratch / "three");
    EXPECT_EQ(read_json(scratch / "one/summary.json")["result_sha256"],
              read_json(scratch / "three/summary.json")["result_sha256"]);
    // Other tiles, shared by other numbers of ranks.
    for (const auto& [ranks, side] : {std::pair(2, "64"), std::pair(3, "100")}) {
        const std::string dir = scratch / ("tiles" + std::string(side));
        const Output tiles = mpirun(ranks, {VFPLAN_BINARY, "run", job, "--out", dir, "--threads",
                                            "1", "--set", "field.tile_cells=" + std::string(side)});
        EXPECT_EQ(tiles.code, 0) << tiles.err;
        EXPECT_EQ(read_json(Path(dir) / "summary.json")["result_sha256"],
                  read_json(scratch / "one/summary.json")["result_sha256"]);
        for (const char* name :
             {"coverage.h5", "pool.h5", "plan.h5", "stations.csv", "links.csv"}) {
            EXPECT_EQ(read_bytes(Path(dir) / name), read_bytes(Path(scratch / "one") / name))
                << name << ", tiles of " << side;
        }
    }
    const Output bad = mpirun(3, {VFPLAN_BINARY, "run", job, "--set", "field.cell_m=-1"});
    EXPECT_EQ(bad.code, 2);
    EXPECT_EQ(count_of("vfplan: ", bad.err), 1U) << bad.err;
}

}  // namespace
}  // namespace vfplan::test
