// The stages after the field, one thread, on the generated town and city. What each computes is
// verified by the tests; here a digest of it must be the same in every iteration.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "bench/scenes.h"
#include "engine/job/tables.h"
#include "engine/plan/overlap_graph.h"
#include "engine/plan/planning.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "io/tables/field_tiles.h"
#include "kernels/free_cells.h"
#include "kernels/index.h"
#include "kernels/ridges.h"
#include "kernels/skeleton.h"

namespace vfplan::bench {
namespace {

std::filesystem::path folder(const std::string& name) {
    return std::filesystem::temp_directory_path() /
           ("vfplan_bench_" + name + "_" + std::to_string(getpid()));
}

// Everything that a job makes on its way, made once in a run directory.
struct Made {
    const Scene* scene;
    std::filesystem::path dir;
    std::string key = "bench";
    Threads threads{1};
    Ranks ranks;
    Progress progress{true};
    Raster<float> vf_rad;
    Raster<std::uint8_t> closed;
    Raster<std::uint8_t> domain;
    DistanceField distance;
    SkeletonCells skeleton;
    std::unique_ptr<CoverageTables> coverage;
    std::unique_ptr<CoverageEntries> entries;
    std::unique_ptr<PlanTables> plan;
    std::unique_ptr<Scenes> scenes;

    explicit Made(const std::string& name) : scene(bench::scene(name)), dir(folder(name)) {
        write_site(*scene, dir, key);
        {
            const SiteStore store(dir / "work" / "site.h5", scene->config.field.tile_cells);
            std::vector<PatchSite> patches;
            for (std::int64_t p = 0; p < store.layout().patches(); ++p) {
                patches.push_back(store.patch(p));
            }
            scenes = std::make_unique<Scenes>(
                store.layout(), [of = std::move(patches)](std::int64_t p) { return of[idx(p)]; },
                scene_options(scene->config), 1000);
        }
        make_tables(table_options(scene->config), dir, key, threads, ranks, progress);
        const Grid& g = scene->grid();
        const FieldTiles tiles(
            scene->layout, {dir / "shards", "field", fmt::format("-{}", scene->layout.tile_cells)});
        FieldWindow field = tiles.window({0, 0, g.nx, g.ny});
        domain = field.domain(scene->config.field.threshold_rad);
        vf_rad = std::move(field.vf_rad);
        closed = std::move(field.closed);
        make_distance();
        skeleton = thinned();
        coverage = std::make_unique<CoverageTables>(read_coverage(dir / "coverage.h5"));
        entries = std::make_unique<CoverageEntries>(dir / "coverage.h5");
        plan = std::make_unique<PlanTables>(
            plan_tables_of(*coverage, *entries, plan_options(scene->config).overlap.ratio));
    }
    ~Made() {
        std::error_code ignored;
        std::filesystem::remove_all(dir, ignored);
    }
    Made(const Made&) = delete;
    Made& operator=(const Made&) = delete;

    void make_distance() {
        const Grid& g = scene->grid();
        distance.resize(g.size());
        distance_columns(g, domain, 0, g.nx, distance);
        distance_rows(g, domain, 0, g.ny, distance);
    }
    SkeletonCells thinned() const {
        const std::vector<Cell> state = thin(scene->grid(), domain, distance);
        SkeletonCells out;
        for (std::size_t i = 0; i < state.size(); ++i) {
            if (state[i] != Cell::present) continue;
            out.cell.push_back(static_cast<std::int64_t>(i));
            out.squared.push_back(distance.squared[i]);
        }
        return out;
    }
};

Made& made(const std::string& name) {
    static std::map<std::string, std::unique_ptr<Made>> all;
    auto& m = all[name];
    if (!m) m = std::make_unique<Made>(name);
    return *m;
}

void per_item(benchmark::State& state, const char* item, std::int64_t count) {
    state.counters[item] = static_cast<double>(count);
    state.counters["s_per_item"] = benchmark::Counter(
        static_cast<double>(count),
        benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// Runs `work`, which returns a number that sums up its result and must not change.
template <class Work>
void timed(benchmark::State& state, const Work& work) {
    const auto want = work();
    for (auto _ : state) {
        if (work() != want) return state.SkipWithError("two runs, two results");
    }
    state.counters["digest"] = static_cast<double>(want);
}

std::int64_t count_set(const Raster<std::uint8_t>& r) { return std::count(r.begin(), r.end(), 1); }

void stage_free_cells(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    timed(state, [&] { return count_set(free_cells(m.scene->grid(), m.scene->site.free_border)); });
    per_item(state, "cells", m.scene->grid().size());
}

void stage_distance(benchmark::State& state, const std::string& site) {
    Made& m = made(site);
    timed(state, [&] {
        m.make_distance();
        std::int64_t sum = 0;
        for (const std::int32_t d : m.distance.squared) sum += d;
        return sum;
    });
    per_item(state, "cells", m.scene->grid().size());
}

void stage_thin(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    timed(state, [&] { return m.thinned().cell.size(); });
    per_item(state, "cells", m.scene->grid().size());
}

void stage_ridges(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    timed(state, [&] {
        SkeletonCells skeleton = m.skeleton;
        prune_spurs(m.scene->grid(), skeleton);
        return ridge_graph(m.scene->grid(), skeleton).ridges.size();
    });
    per_item(state, "cells", m.scene->grid().size());
}

// In scenes that stand already; those of a job are made once for many rows.
void stage_coverage_rows(benchmark::State& state, const std::string& site) {
    Made& m = made(site);
    std::vector<Vec2d> eyes;
    for (const Candidate& c : m.coverage->candidates) eyes.push_back(c.at);
    std::vector<CoverageRow> rows(eyes.size());
    std::size_t entries = 0;
    timed(state, [&] {
        m.scenes->each(m.threads, eyes, [&](std::size_t i, const vfplan::Scene& scene) {
            rows[i] = scene.look(eyes[i]).row;
        });
        entries = 0;
        for (const CoverageRow& row : rows) entries += row.size();
        return entries;
    });
    std::vector<std::int32_t> pieces;
    for (const CoverageRow& row : rows) {
        for (const Seen& s : row) pieces.push_back(s.piece);
    }
    if (pieces != m.plan->rows.piece) {
        return state.SkipWithError("the rows differ from the job's table");
    }
    per_item(state, "rows", static_cast<std::int64_t>(eyes.size()));
    state.counters["entries"] = static_cast<double>(entries);
}

void stage_overlap(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    const PlanOptions options = plan_options(m.scene->config);
    std::size_t pairs = 0;
    timed(state, [&] {
        pairs = static_cast<std::size_t>(
            make_graph(
                overlap_pairs(m.threads, m.plan->rows, m.plan->piece_length_m, options.overlap))
                .edges());
        return pairs;
    });
    per_item(state, "rows", m.coverage->rows());
    state.counters["links"] = static_cast<double>(pairs);
}

void stage_plan(benchmark::State& state, const std::string& site) {
    Made& m = made(site);
    std::size_t stations = 0;
    timed(state, [&] {
        stations = plan_stations(*m.plan, plan_options(m.scene->config),
                                 m.scene->config.scanner.range_max_m, m.threads, m.progress)
                       .plan.stations.size();
        return stations;
    });
    per_item(state, "candidates", m.coverage->rows());
    state.counters["stations"] = static_cast<double>(stations);
}

// One tile of the field and one block of rows as shards, with their indices.
void stage_write_tables(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    const std::filesystem::path dir = folder("tables");
    std::filesystem::create_directories(dir / "shards");
    const std::filesystem::path tile = dir / "shards" / "field-00000.h5";
    const std::filesystem::path rows = dir / "shards" / "coverage-00000.h5";
    const Grid& g = m.scene->grid();
    CoverageBlock block{m.coverage->candidates, {}};
    const auto fractions = m.entries->fractions(0, m.coverage->entries());
    const auto angles = m.entries->angles_rad(0, m.coverage->entries());
    for (std::int64_t r = 0; r < m.coverage->rows(); ++r) {
        CoverageRow row;
        for (std::int64_t i = m.coverage->begin[idx(r)]; i < m.coverage->begin[idx(r) + 1]; ++i) {
            row.push_back({m.plan->rows.piece[idx(i)], fractions[idx(i)], angles[idx(i)]});
        }
        block.table.add(row);
    }
    Layout layout = m.scene->layout;
    layout.tile_cells = std::max(g.nx, g.ny);  // all in one
    const auto write = [&] {
        write_field_tile(tile, m.key, {{0, 0, g.nx, g.ny}, m.vf_rad, m.closed, {}});
        write_field_index(dir / "field.h5", {layout, {0, 0}, "", m.key, "{}"}, {tile});
        write_coverage_block(rows, m.key, block);
        write_coverage_index(dir / "coverage.h5", m.coverage->walls, m.coverage->pieces, {rows},
                             {{0, 0}, "", m.key, "{}", {}});
        return m.vf_rad.size() + block.table.seen.size();
    };
    timed(state, write);
    const Raster<float> read = FieldFile(dir / "field.h5").read({0, 0, g.nx, g.ny});
    const bool same =
        std::equal(read.begin(), read.end(), m.vf_rad.begin(), m.vf_rad.end(),
                   [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); });
    if (!same || read_coverage(dir / "coverage.h5").entries() != m.coverage->entries()) {
        state.SkipWithError("what was written reads back as something else");
    }
    std::filesystem::remove_all(dir);
    per_item(state, "cells", g.size());
}

#define VFPLAN_STAGE(function)                                                \
    BENCHMARK_CAPTURE(function, town, "town")->Unit(benchmark::kMillisecond); \
    BENCHMARK_CAPTURE(function, city, "city")->Unit(benchmark::kMillisecond)

VFPLAN_STAGE(stage_free_cells);
VFPLAN_STAGE(stage_distance);
VFPLAN_STAGE(stage_thin);
VFPLAN_STAGE(stage_ridges);
VFPLAN_STAGE(stage_coverage_rows);
VFPLAN_STAGE(stage_overlap);
VFPLAN_STAGE(stage_plan);
VFPLAN_STAGE(stage_write_tables);

}  // namespace
}  // namespace vfplan::bench
