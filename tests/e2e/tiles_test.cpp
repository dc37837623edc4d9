// Tiles are portions of work only: any side, any number of threads, one result.
#include <fmt/format.h>

#include <cmath>

#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "io/tables/plan_file.h"
#include "program.h"

namespace vfplan::test {
namespace {

void expect_same_field(const Path& a, const Path& b) {
    const FieldFile one(a / "field.h5");
    const FieldFile two(b / "field.h5");
    ASSERT_EQ(one.grid().nx, two.grid().nx);
    ASSERT_EQ(one.grid().ny, two.grid().ny);
    const Window whole{0, 0, one.grid().nx, one.grid().ny};
    const Raster<float> x = one.read(whole);
    const Raster<float> y = two.read(whole);
    std::int64_t differ = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        differ += x[i] == y[i] || (std::isnan(x[i]) && std::isnan(y[i])) ? 0 : 1;
    }
    EXPECT_EQ(differ, 0);
}

// Walls from one point outwards, which only cells between them see: many are rescued, in tiles that
// are smaller than the range.
std::string star(const Scratch& scratch) {
    Features walls;
    for (int k = 0; k < 150; ++k) {
        const double a = 2 * M_PI * k / 150;
        const double r = 20 + k * 37 % 41;
        walls.push_back({"wall", "LineString",
                         fmt::format("[[0,0],[{:.6f},{:.6f}]]", r * std::cos(a), r * std::sin(a))});
    }
    return scratch.write("star.geojson", geojson(walls));
}

struct Kind {
    const char* name;
    const char* preset;
    const char* cell_m;
    const char* range_m;
};

void PrintTo(const Kind& k, std::ostream* out) { *out << k.name; }

class Tiles : public ::testing::TestWithParam<Kind> {};

TEST_P(Tiles, SidesAndThreadsDoNotMatter) {
    const Scratch scratch;
    const auto& [name, preset, cell_m, range_m] = GetParam();
    const std::string kind = name;
    const std::string site =
        kind == "star"
            ? star(scratch)
            : generated(scratch, kind, kind == "city" ? Words{"--size-km", "0.5"} : Words{});
    const std::string job = scratch.write(
        "job.toml", fmt::format("preset = \"{}\"\n[site]\ninput = \"{}\"\n[field]\ncell_m = {}\n"
                                "[scanner]\nrange_max_m = {}\n[output]\n"
                                "formats = [\"csv\", \"geojson\"]\n",
                                preset, site, cell_m, range_m));
    const auto run = [&](const std::string& dir, const std::string& side, const char* threads) {
        vfplan_expect(0, {"run", job, "--out", scratch / dir, "--quiet", "--threads", threads,
                          "--set", "field.tile_cells=" + side});
        return Path(scratch / dir);
    };
    const Path first = run("first", "256", "1");
    for (const auto& [side, threads] :
         {std::pair("64", "2"), std::pair("100", "1"), std::pair("100", "3"),
          std::pair("1024", "2"), std::pair("256", "2")}) {
        const Path other = run("other", side, threads);
        SCOPED_TRACE(std::string("tiles of ") + side + ", threads " + threads);
        EXPECT_EQ(read_json(first / "summary.json")["result_sha256"],
                  read_json(other / "summary.json")["result_sha256"]);
        for (const char* file :
             {"coverage.h5", "shards/coverage-00000.h5", "pool.h5", "shards/pool-00000.h5",
              "plan.h5", "stations.csv", "stations.geojson", "links.csv", "pieces.csv"}) {
            EXPECT_EQ(read_bytes(first / file), read_bytes(other / file)) << file;
        }
        expect_same_field(first, other);
        if (std::string(side) == "256") expect_same_bytes(first, other);
        vfplan_expect(0, {"verify", other});
        std::filesystem::remove_all(other);
    }
}

INSTANTIATE_TEST_SUITE_P(Sites, Tiles,
                         ::testing::Values(Kind{"city", "outdoor", "1.5", "25"},
                                           Kind{"flat", "indoor", "0.05", "3"},
                                           Kind{"star", "outdoor", "1", "40"}),
                         [](const auto& i) { return std::string(i.param.name); });

// The tables of a run may be replanned and verified whatever the tiles of the job at hand.
TEST(TilesTest, AnotherSideInAFinishedFolderChangesNothing) {
    const Scratch scratch;
    const std::string site = generated(scratch, "city", {"--size-km", "0.5"});
    const std::string job = scratch.write(
        "job.toml",
        "preset = \"outdoor\"\n[site]\ninput = \"" + site +
            "\"\n[field]\ncell_m = 4\ntile_cells = 64\n[output]\nformats = [\"csv\"]\n");
    vfplan_expect(0, {"run", job, "--out", scratch / "run", "--quiet"});
    const auto before = lasting_bytes(scratch / "run");
    vfplan_expect(
        0, {"run", job, "--out", scratch / "run", "--quiet", "--set", "field.tile_cells=256"});
    EXPECT_EQ(lasting_bytes(scratch / "run"), before);
    vfplan_expect(0, {"verify", scratch / "run"});
}

}  // namespace
}  // namespace vfplan::test
