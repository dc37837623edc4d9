// Little sites by chance: as many networks as over all free cells, and the thresholds at which they
// would join, against brute force. VFPLAN_RANDOM_SITES says how many of each kind (24);
// `make random-networks` takes 400.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "engine/job/tables.h"
#include "engine/plan/planning.h"
#include "engine/tables/site.h"
#include "kernels/error.h"
#include "tests/engine/joining/all_cells.h"
#include "tests/io/site/random_sites.h"

namespace vfplan {
namespace {

using test::AllCells;
using test::for_sites;
using test::Random;

struct Setting {
    GroundOptions ground;
    TableOptions tables;
};

Setting random_setting(Random& random, bool outdoor) {
    Setting s;
    const double range = random.between(2, outdoor ? 25 : 12);
    SceneOptions& o = s.tables.scenes;
    o.scanner.range_max_m = range;
    o.scanner.range_min_m = random.one_in(3) ? 0 : range / 10;
    o.scanner.max_incidence_deg = random.one_in(3) ? 75 : 90;
    o.partition_m = std::array{0.25, 0.5, 1.0, 5.0}[static_cast<std::size_t>(random.below(4))];
    o.visible_fraction = std::array{0.1, 0.5, 0.9}[static_cast<std::size_t>(random.below(3))];
    s.tables.threshold_rad = random.one_in(3) ? 0.2 : 1;
    s.tables.overlap.ratio =
        static_cast<OverlapRatio>(random.below(static_cast<int>(overlap_ratio_count)));
    // Simple fractions are met exactly by some pairs.
    s.tables.overlap.threshold = random.one_in(2) ? 0.5 : 0.1 * (2 + random.below(7));
    s.tables.tile_cells = std::array{16, 64, 1024}[static_cast<std::size_t>(random.below(3))];
    s.ground.cell_m = outdoor ? random.between(0.6, 1.1) : random.between(0.2, 0.5);
    s.ground.clearance_m = random.one_in(2) ? 0.3 : 0;
    s.ground.tile_cells = s.tables.tile_cells;
    s.ground.range_max_m = range;
    s.ground.partition_m = o.partition_m;
    return s;
}

// A run directory with the tables of a site.
class Made {
public:
    Made(const Site& site, const Setting& s, int thread_count = 1)
        : threads_(thread_count), options_(s.tables) {
        std::filesystem::create_directories(dir_ / "work");
        store_site(s.ground, key_, site, {}, threads_, dir_ / "work" / "site.h5", true);
        store_ = std::make_unique<SiteStore>(dir_ / "work" / "site.h5", s.tables.tile_cells);
        if (store_->facts().free_cells == 0) return;
        try {
            make_tables(s.tables, dir_, key_, threads_, ranks_, progress_);
            tables = read_coverage(dir_ / "coverage.h5");
            good = true;
        } catch (const UsageError&) {
            // Nothing is seen from anywhere.
        }
    }
    Planned plan() {
        const CoverageEntries entries(dir_ / "coverage.h5");
        PlanOptions o;
        o.method = PlanMethod::greedy;
        o.loops = false;
        o.overlap = options_.overlap;
        return plan_stations(plan_tables_of(tables, entries, o.overlap.ratio), o,
                             options_.scenes.scanner.range_max_m, threads_, progress_);
    }
    const SiteStore& store() const { return *store_; }
    std::string bytes(const char* file) const {
        std::ifstream in(dir_ / file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    bool good = false;
    CoverageTables tables;

private:
    inline static int made_ = 0;
    TemporaryFolder folder_{fmt::format("networks{}", made_++)};
    std::filesystem::path dir_ = folder_.path();
    std::string key_ = "key";
    Threads threads_;
    Ranks ranks_;
    Progress progress_{true};
    TableOptions options_;
    std::unique_ptr<SiteStore> store_;
};

Site random_site(Random& random, bool outdoor) {
    SiteOptions o;
    o.kind = outdoor ? SiteKind::outdoor : SiteKind::indoor;
    if (outdoor) o.invalid = InvalidPolygons::repair;
    o.margin_m = outdoor ? 4 : o.margin_m;
    return build_site(outdoor ? random_town(random) : random_plan(random), o, "random").site;
}

struct Counts {
    int sites = 0;
    int several = 0;  // networks
    int joined = 0;   // by free cells
    int fewer = 0;    // than over all free cells
    int more = 0;
};

void expect_as_over_all_cells(std::uint64_t seed, bool outdoor, Counts& counts) {
    Random random(seed + (outdoor ? 5000000 : 6000000));
    const Site site = random_site(random, outdoor);
    const Setting setting = random_setting(random, outdoor);
    Made made(site, setting);
    if (!made.good) return;
    const Planned planned = made.plan();
    if (planned.metrics.networks == 0) return;
    ++counts.sites;
    const AllCells all(made.store(), setting.tables.scenes, made.tables, setting.tables.overlap);
    const std::int64_t truth = all.networks();
    if (planned.metrics.networks < truth) ++counts.fewer;
    if (planned.metrics.networks > truth) ++counts.more;
    EXPECT_LE(planned.metrics.networks, truth) << all.rows() << " rows";
    if (made.tables.apart.free_cells == 0) return;
    ++counts.joined;
    // As other tiles and threads have it.
    Setting other = setting;
    other.tables.tile_cells = other.ground.tile_cells = setting.tables.tile_cells == 16 ? 256 : 20;
    const Made again(site, other, 2);
    EXPECT_EQ(made.bytes("coverage.h5"), again.bytes("coverage.h5"));
    EXPECT_EQ(made.bytes("shards/coverage-00000.h5"), again.bytes("shards/coverage-00000.h5"));
    if (planned.metrics.networks < 2) return;
    ++counts.several;
    EXPECT_EQ(planned.join_thresholds.free_cells, all.free_cells());
    std::vector<std::int32_t> first(idx(planned.metrics.networks), -1);
    for (const Station& s : planned.plan.stations) {
        if (first[idx(s.network)] < 0) first[idx(s.network)] = s.candidate;
    }
    for (std::size_t n = 1; n < first.size(); ++n) {
        EXPECT_NEAR(planned.join_thresholds.joins_at[n], all.joins_at(first[0], first[n]), 1e-12)
            << "network " << n;
        EXPECT_FALSE(setting.tables.overlap.enough(planned.join_thresholds.joins_at[n]));
    }
}

void report(const Counts& c) {
    fmt::print(
        "{} sites, {} with components apart after paths, {} of these with several networks, "
        "{} with fewer and {} with more than over all free cells\n",
        c.sites, c.joined, c.several, c.fewer, c.more);
}

constexpr std::uint64_t sites_by_default = 24;

TEST(RandomNetworks, IndoorsAreAsManyAsOverAllFreeCells) {
    Counts counts;
    for_sites([&](std::uint64_t seed) { expect_as_over_all_cells(seed, false, counts); },
              sites_by_default);
    report(counts);
    EXPECT_GT(counts.sites, 0);
}

TEST(RandomNetworks, OutdoorsAreAsManyAsOverAllFreeCells) {
    Counts counts;
    for_sites([&](std::uint64_t seed) { expect_as_over_all_cells(seed, true, counts); },
              sites_by_default);
    report(counts);
    EXPECT_GT(counts.sites, 0);
}

}  // namespace
}  // namespace vfplan
