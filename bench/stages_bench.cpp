// The stages after the field, one thread, on the generated town and city. What each computes is
// verified by the tests; here a digest of it must be the same in every iteration.
#include <benchmark/benchmark.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include "bench/scenes.h"
#include "engine/graph.h"
#include "engine/plan_stage.h"
#include "engine/viewer.h"
#include "kernels/exact_scene.h"
#include "kernels/free_cells.h"
#include "kernels/index.h"
#include "kernels/skeleton.h"

namespace vfplan::bench {
namespace {

// Everything that a job makes on its way, made once.
struct Made {
    const Scene* scene;
    Threads threads{1};
    Progress progress{true};
    Tables tables;
    Raster<std::uint8_t> domain;
    DistanceField distance;
    Raster<std::uint8_t> skeleton;
    std::unique_ptr<ExactScene> kernel;
    std::unique_ptr<Viewer> viewer;

    explicit Made(const std::string& name) : scene(bench::scene(name)) {
        tables = make_tables(scene->config, scene->prepared, "bench", threads, progress);
        const auto threshold = static_cast<float>(scene->config.field.threshold_rad);
        for (const float vf : tables.field.vf_rad) domain.push_back(vf >= threshold ? 1 : 0);
        make_distance();
        skeleton = thin(scene->grid(), domain, distance);
        kernel = std::make_unique<ExactScene>(scene->walls(), scene->extent(),
                                              scene->scanner().range_max_m);
        viewer =
            std::make_unique<Viewer>(*kernel, scene->walls(), tables.coverage.pieces,
                                     scene->scanner(), scene->config.coverage.visible_fraction);
    }
    void make_distance() {
        const Grid& g = scene->grid();
        distance.resize(g.size());
        distance_columns(g, domain, 0, g.nx, distance);
        distance_rows(g, domain, 0, g.ny, distance);
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
    timed(state, [&] {
        return count_set(free_cells(m.scene->grid(), m.scene->prepared.site.free_region));
    });
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
    timed(state, [&] { return count_set(thin(m.scene->grid(), m.domain, m.distance)); });
    per_item(state, "cells", m.scene->grid().size());
}

void stage_ridges(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    timed(state, [&] {
        Raster<std::uint8_t> skeleton = m.skeleton;
        prune_spurs(m.scene->grid(), m.distance, skeleton);
        return ridge_graph(m.scene->grid(), skeleton).ridges.size();
    });
    per_item(state, "cells", m.scene->grid().size());
}

void stage_coverage_rows(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    std::vector<Vec2d> eyes;
    for (const Candidate& c : m.tables.coverage.candidates) eyes.push_back(c.at);
    std::size_t entries = 0;
    timed(state, [&] {
        entries = 0;
        for (const CoverageRow& row : m.viewer->rows(m.threads, eyes)) entries += row.size();
        return entries;
    });
    if (entries != m.tables.coverage.table.seen.size()) {
        return state.SkipWithError("the rows differ from the job's table");
    }
    per_item(state, "rows", static_cast<std::int64_t>(eyes.size()));
    state.counters["entries"] = static_cast<double>(entries);
}

void stage_overlap(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    const CoverageTables& c = m.tables.coverage;
    std::size_t pairs = 0;
    timed(state, [&] {
        pairs = static_cast<std::size_t>(
            overlap_graph(m.threads, c.pieces, c.table, ratio_of(m.scene->config.overlap.ratio),
                          m.scene->config.overlap.threshold)
                .edges());
        return pairs;
    });
    per_item(state, "rows", c.table.rows());
    state.counters["links"] = static_cast<double>(pairs);
}

void stage_plan(benchmark::State& state, const std::string& site) {
    Made& m = made(site);
    std::size_t stations = 0;
    timed(state, [&] {
        stations = plan_tables(m.scene->config, m.tables.coverage, m.threads, m.progress)
                       .plan.stations.size();
        return stations;
    });
    per_item(state, "candidates", m.tables.coverage.table.rows());
    state.counters["stations"] = static_cast<double>(stations);
}

void stage_write_tables(benchmark::State& state, const std::string& site) {
    const Made& m = made(site);
    const std::filesystem::path dir = std::filesystem::temp_directory_path() /
                                      ("vfplan_bench_tables_" + std::to_string(getpid()));
    std::filesystem::create_directories(dir);
    const auto write = [&] {
        write_field(dir / "field.h5", m.tables.field);
        write_coverage(dir / "coverage.h5", m.tables.coverage);
        return m.tables.field.vf_rad.size() + m.tables.coverage.table.seen.size();
    };
    timed(state, write);
    const Raster<float> read = read_field(dir / "field.h5").vf_rad;
    const bool same = std::equal(
        read.begin(), read.end(), m.tables.field.vf_rad.begin(), m.tables.field.vf_rad.end(),
        [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); });
    if (!same || read_coverage(dir / "coverage.h5").table.seen.size() !=
                     m.tables.coverage.table.seen.size()) {
        state.SkipWithError("what was written reads back as something else");
    }
    std::filesystem::remove_all(dir);
    per_item(state, "cells", m.scene->grid().size());
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
