// One job, one result: whatever the threads, the instruction set and the place on the map.
#include <algorithm>
#include <fstream>

#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "io/tables/plan_file.h"
#include "program.h"

namespace vfplan::test {
namespace {

// The instruction sets of this machine that Embree can be held to.
std::vector<std::string> instruction_sets() {
    std::ifstream in("/proc/cpuinfo");
    std::string line;
    while (std::getline(in, line) && line.rfind("flags", 0) != 0) continue;
    std::vector<std::string> out;
    for (const char* isa : {"sse2", "sse4.2", "avx", "avx2", "avx512"}) {
        std::string flag = std::string(isa) == "avx512" ? "avx512vl" : isa;
        std::replace(flag.begin(), flag.end(), '.', '_');
        if ((line + " ").find(" " + flag + " ") != std::string::npos) out.emplace_back(isa);
    }
    return out;
}

struct Case {
    const char* site;
    const char* kernel;
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.site << ", kernel " << c.kernel; }

class Determinism : public ::testing::TestWithParam<Case> {
protected:
    void SetUp() override { site = generated(scratch, GetParam().site); }

    std::string run(const std::string& name, const Words& more, const Environment& environment = {},
                    const std::vector<std::string>& sets = {}) {
        const bool town = std::string(GetParam().site) == "town";
        std::vector<std::string> all = {
            "site.input=" + site, std::string("visibility.kernel=") + GetParam().kernel,
            town ? "site.crop_m=[0,0,400,292]" : "site.crop_m=[]",
            town ? "field.cell_m=4" : "field.cell_m=0.1", "output.formats=['csv','geojson']"};
        all.insert(all.end(), sets.begin(), sets.end());
        Words words = with_sets({"run", config_file(std::string(GetParam().site) + ".toml"),
                                 "--out", scratch / name, "--quiet"},
                                all);
        words.insert(words.end(), more.begin(), more.end());
        vfplan_expect(0, words, environment);
        return scratch / name;
    }

    static std::string hash(const Path& dir) {
        return read_json(dir / "summary.json")["result_sha256"];
    }

    Scratch scratch;
    std::string site;
};

TEST_P(Determinism, ThreadsDoNotMatter) {
    const std::string one = run("one", {"--threads", "1"});
    for (const char* n : {"2", "5"}) {
        const std::string more = run(std::string("threads") + n, {"--threads", n});
        EXPECT_EQ(hash(one), hash(more)) << n << " threads";
        expect_same_bytes(one, more);
    }
}

TEST_P(Determinism, ThreadsDoNotMatterToProofs) {
    const std::vector<std::string> sets = {"plan.method=certified", "plan.proof_effort=200"};
    expect_same_bytes(run("one", {"--threads", "1"}, {}, sets),
                      run("three", {"--threads", "3"}, {}, sets));
}

TEST_P(Determinism, InstructionSetsDoNotMatter) {
    const auto sets = instruction_sets();
    ASSERT_FALSE(sets.empty());
    const std::string all = run("all", {});
    for (const std::string& isa : sets) {
        const std::string held = run(isa, {}, {{"VFPLAN_ISA", isa}});
        EXPECT_EQ(hash(all), hash(held)) << isa;
        expect_same_bytes(all, held);
    }
    const Output o = vfplan_process({"parameters"}, {{"VFPLAN_ISA", "abacus"}});
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("abacus"), std::string::npos) << o.err;
}

// 0.5 m are the steps of floats at such coordinates: every frame must be local.
TEST_P(Determinism, TheMapsPlaceDoesNotMatter) {
    constexpr double dx = 500000;
    constexpr double dy = 5400000;
    const std::string here = run("here", {});
    site = scratch.write("far.geojson", shifted(read_bytes(site), dx, dy));
    const std::string there =
        run("there", {}, {},
            {std::string(GetParam().site) == "town" ? "site.crop_m=[500000,5400000,500400,5400292]"
                                                    : "site.crop_m=[]"});

    const CoverageTables a = read_coverage(Path(here) / "coverage.h5");
    const CoverageTables b = read_coverage(Path(there) / "coverage.h5");
    EXPECT_EQ(a.pieces.size(), b.pieces.size());
    ASSERT_EQ(a.candidates.size(), b.candidates.size());
    for (std::size_t i = 0; i < a.candidates.size(); ++i) {
        const Vec2d p = a.origin + a.candidates[i].at + Vec2d(dx, dy);
        EXPECT_LT((p - b.origin - b.candidates[i].at).norm(), 1e-6) << "candidate " << i;
        EXPECT_EQ(a.candidates[i].kind, b.candidates[i].kind) << "candidate " << i;
        EXPECT_EQ(a.candidates[i].cell, b.candidates[i].cell) << "candidate " << i;
    }
    const Csv one = read_csv(Path(here) / "stations.csv");
    const Csv two = read_csv(Path(there) / "stations.csv");
    ASSERT_EQ(one.rows.size(), two.rows.size());
    const auto x1 = one.numbers("x");
    const auto y1 = one.numbers("y");
    const auto x2 = two.numbers("x");
    const auto y2 = two.numbers("y");
    for (std::size_t i = 0; i < x1.size(); ++i) {
        EXPECT_NEAR(x1[i] + dx, x2[i], 2e-4) << "station " << i;
        EXPECT_NEAR(y1[i] + dy, y2[i], 2e-4) << "station " << i;
    }
    EXPECT_EQ(read_csv(Path(here) / "links.csv").rows.size(),
              read_csv(Path(there) / "links.csv").rows.size());
    vfplan_expect(0, {"verify", there});
}

INSTANTIATE_TEST_SUITE_P(Kernels, Determinism,
                         ::testing::Values(Case{"town", "embree"}, Case{"town", "exact"},
                                           Case{"flat", "embree"}, Case{"flat", "exact"}),
                         [](const auto& i) {
                             return std::string(i.param.site) + "_" + i.param.kernel;
                         });

}  // namespace
}  // namespace vfplan::test
