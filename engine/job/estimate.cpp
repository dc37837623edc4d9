#include "engine/job/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "engine/config/options.h"
#include "engine/job/needs.h"
#include "engine/joining/paths.h"
#include "engine/runtime/memory.h"
#include "engine/runtime/stop.h"
#include "engine/tables/field.h"
#include "engine/tables/site.h"
#include "engine/tables/skeleton.h"
#include "engine/tables/standable.h"
#include "io/exports/outputs.h"
#include "kernels/coverage.h"

namespace vfplan {
namespace {

constexpr const char* less_memory =
    "larger cells or pieces, smaller tiles (field.tile_cells), a shorter range, or site.crop_m";

// Bytes and seconds that follow from counts, measured on a city of 25 km2 (docs/performance.md).
double plan_memory_mb(const Estimate& e, double walls) {
    // Rows and their index, lengths and marks of pieces, graph, walls, candidates.
    return (8.0 * static_cast<double>(e.entries) + 30.0 * static_cast<double>(e.pieces) +
            600.0 * static_cast<double>(e.candidates) + 90.0 * walls) /
           1e6;
}

// What the files beside the shards take, by one of their costs.
double outputs_take(const Config& config, const Estimate& e, OutputCost Output::*cost) {
    const auto& formats = config.output.formats;
    const double pixels = std::pow(static_cast<double>(config.output.map_px), 2);
    constexpr double uncovered = 0.2;  // share of pieces, at the most of the sites at hand
    const double listed =
        static_cast<double>(e.pieces) * (lists_all(config.output.pieces, e.pieces) ? 1 : uncovered);
    double sum = 0;
    for (const Output& o : outputs()) {
        if (!is_asked(formats, o.format)) continue;
        sum += (o.*cost).of(listed, static_cast<double>(e.candidates), pixels);
    }
    return sum;
}

double files_mb(const Config& config, const Estimate& e, double walls) {
    const double tables =
        8 * static_cast<double>(e.pieces) + 25 * static_cast<double>(e.candidates) + 40 * walls;
    return (tables + outputs_take(config, e, &Output::bytes)) / 1e6;
}

double plan_s(const Config& config, const Estimate& e) {
    const auto entries = static_cast<double>(e.entries);
    if (config.plan.method == PlanMethod::greedy) return 3.5e-7 * entries;
    // The search takes steps for each station, of which there are more where there are more
    // candidates.
    constexpr double usual_effort = 20;
    return 5e-4 * static_cast<double>(e.candidates) *
               (static_cast<double>(config.plan.effort) / usual_effort) +
           1e-6 * entries;
}

double files_s(const Config& config, const Estimate& e) {
    return 1e-6 * static_cast<double>(e.pieces) + 1.5e-9 * static_cast<double>(e.cells) +
           outputs_take(config, e, &Output::seconds);
}

double tables_memory_mb(const Layout& layout, double range_m, const Estimate& e, double walls,
                        const Threads& threads) {
    const double range = range_m / layout.grid.cell_m;
    const auto cells = static_cast<double>(e.cells);
    const double patch = layout.largest_patch_cells();
    const double lanes = std::min<double>(threads.count(), static_cast<double>(layout.tiles()));
    const auto at_once = [&](double task_bytes) {
        return task_bytes * std::min<double>(lanes, tasks_at_once(task_bytes, threads.count()));
    };
    // A bit of each cell, and four bytes of some while free ones are found; then what phases hold
    // of the windows that they work on.
    const double site =
        cells / 8 +
        lanes * 4 * std::min(cells, std::max(patch, static_cast<double>(cells_at_once)));
    const double window = layout.largest_window_cells(range + 50);
    const double rows = lanes * 24 * static_cast<double>(e.entries) * window / cells;
    const double near = std::min(walls, walls * 4 * patch / cells);  // of a patch, and around it
    const double scene = 800 * near;
    return (std::max({site, at_once(field_task_bytes(layout)),
                      at_once(skeleton_task_bytes(layout, range)) + rows,
                      at_once(paths_task_bytes(layout, range))}) +
            scene) /
           1e6;
}

// What tiles cost beside their cells, in files; small tiles on a large grid are many.
constexpr double field_shard_mb = 0.010;
constexpr double passing_shards_mb = 0.006;  // of all phases

double shards_s(const Layout& layout, double range_m) {
    constexpr double write_s = 0.03;  // through all phases
    constexpr double read_s = 3e-4;
    const double margin = range_m / layout.grid.cell_m + skeleton_margin_cells;
    const auto read_along = [&](std::int32_t cells) {
        return std::ceil(std::min<double>(cells, layout.tile_cells + 2 * margin) /
                         layout.tile_cells);
    };
    const double read = read_along(layout.grid.nx) * read_along(layout.grid.ny);
    return static_cast<double>(layout.tiles() - 1) * (write_s + read * read_s);
}

std::string span_text(double s) {
    if (s < 90) return fmt::format("{:.2g} s", s);
    if (s < 5400) return fmt::format("{:.0f} min", std::ceil(s / 60));
    return fmt::format("{:.3g} h", s / 3600);
}

std::string sample_text(const Sample& s, const Config& config) {
    std::string cells;
    if (s.cell_m > config.field.cell_m) cells = fmt::format(", with cells of {:.2g} m", s.cell_m);
    const std::string clock =
        s.cut_short ? "; a few seconds were not enough for more, so this is rough" : "";
    if (s.share == 0) return "nothing" + clock;
    if (s.squares == 0) return fmt::format("the whole site{}{}", cells, clock);
    return fmt::format("{:.3g} % of the walls, in {} squares{}{}", 100 * s.share, s.squares, cells,
                       clock);
}

}  // namespace

Estimate estimate(const Config& config, const JobOptions& options, Progress& progress) {
    const GroundOptions ground = ground_options(config);
    const Threads threads(options.threads, stop_if_asked);
    const Moment begin = Moment::now();
    std::optional<SignalsEnd> at_once(std::in_place);  // nothing is written yet
    const Site site = read_ground(ground, threads, progress);
    const double site_s = Moment::now().wall_s - begin.wall_s;
    const Layout layout = layout_of(ground, site);
    Estimate e;
    e.cells = layout.grid.size();
    e.pieces = cut_into_pieces(site.walls, ground.partition_m).size();
    check_memory(ground, layout, e.pieces, options.plan, memory_limit());
    constexpr std::int64_t looked_at_most = 20'000'000;
    const Moment count_begin = Moment::now();
    const FreeCells free = count_free_cells(ground, site, layout.grid, threads, looked_at_most);
    const double count_s = Moment::now().wall_s - count_begin.wall_s;
    e.free_cells = free.count;
    e.free_cells_exact = free.exact;
    if (free.exact) check_free_cells(ground, free.count);
    const double site_mb = progress.peak_rss_mb();
    progress.stage("sample");
    at_once.reset();
    e.sample = try_job(ground, table_options(config), site, layout, options.threads);
    const Totals& s = e.sample.site;
    e.candidates = std::llround(s.candidates);
    e.entries = std::llround(s.entries);
    const auto walls = static_cast<double>(site.walls.size());
    const auto cells = static_cast<double>(e.cells);
    // Libraries; and the picture in memory, a few times over.
    const double base_mb = 65 + outputs_take(config, e, &Output::memory_bytes) / 1e6;
    const double range_m = config.scanner.range_max_m;
    // The field is read in bands, each with a copy of its parts.
    const double rows_mb = 8e-6 * layout.grid.nx * std::min<double>(layout.grid.ny, 512);
    e.memory_mb = std::max({site_mb, 65 + tables_memory_mb(layout, range_m, e, walls, threads),
                            base_mb + plan_memory_mb(e, walls), base_mb + rows_mb});
    const auto tiles = static_cast<double>(layout.tiles());
    const double tables_mb = (s.field_bytes + s.coverage_bytes) / 1e6 + field_shard_mb * tiles;
    e.disk_mb = tables_mb + files_mb(config, e, walls);
    e.working_mb = std::max(0.0, s.working_bytes / 1e6 + passing_shards_mb * tiles -
                                     outputs_take(config, e, &Output::bytes) / 1e6);
    const double looked_at = std::min(cells, static_cast<double>(looked_at_most));
    constexpr double serial = 0.12;  // of the tables: what the leader does alone
    e.wall_s =
        site_s + count_s * cells / looked_at + s.cpu_s * (serial + (1 - serial) / threads.count()) +
        shards_s(layout, range_m) / threads.count() + plan_s(config, e) + files_s(config, e) + 0.2;
    progress.finish();
    return e;
}

void warn_of_shortage(const Estimate& e, const std::filesystem::path& out, Progress& progress) {
    const MemoryLimit limit = memory_limit();
    if (1e6 * e.memory_mb > limit.bytes) {
        progress.warn(
            fmt::format("the job takes about {:.2g} GB of memory, and {} {:.2g} GB; take {}",
                        e.memory_mb / 1e3, limit.whose, limit.bytes / 1e9, less_memory));
    }
    std::error_code error;
    std::filesystem::path there = std::filesystem::absolute(out, error);
    while (!std::filesystem::exists(there, error) && there != there.parent_path()) {
        there = there.parent_path();
    }
    const auto space = std::filesystem::space(there, error);
    const double wanted_mb = e.disk_mb + e.working_mb;
    if (!error && 1e6 * wanted_mb > static_cast<double>(space.available)) {
        progress.warn(fmt::format(
            "the job takes about {:.2g} GB of disk, and {} has {:.2g} GB free; free some, choose "
            "another --out, or take larger cells",
            wanted_mb / 1e3, there.string(), static_cast<double>(space.available) / 1e9));
    }
}

void check_estimate(const Estimate& e, const JobOptions& options, const Threads& threads) {
    // The estimate may be twice too much; what a run takes beyond the limit ends it with words.
    if (options.memory_bytes > 0 && 1e6 * e.memory_mb > 2 * options.memory_bytes) {
        throw UsageError(fmt::format(
            "the job takes about {:.2g} GB of memory a process, and --memory grants {:.2g} GB; "
            "take {}, or grant more",
            e.memory_mb / 1e3, options.memory_bytes / 1e9, less_memory));
    }
    if (options.time_s > 0 && e.wall_s > options.time_s) {
        throw UsageError(fmt::format(
            "the job takes about {} with {} thread{}, and --time grants {}; take larger cells or "
            "pieces, plan.candidates = \"axis\", a lower plan.effort, site.crop_m or more threads, "
            "or grant more",
            span_text(e.wall_s), threads.count(), threads.count() == 1 ? "" : "s",
            span_text(options.time_s)));
    }
}

std::string estimate_text(const Estimate& e, const Config& config, const Threads& threads) {
    return fmt::format(
        "cells        {} of {} m, {}{} of them free\n"
        "pieces       {}\n"
        "candidates   about {}, which see {} pieces in all\n"
        "memory       about {:.0f} MB a process\n"
        "disk         about {:.1f} MB, and {:.1f} MB more while it runs\n"
        "time         about {} with {} thread{}\n"
        "tried        {}\n"
        "The job is valid; nothing was written.\n",
        e.cells, config.field.cell_m, e.free_cells_exact ? "" : "about ", e.free_cells, e.pieces,
        e.candidates, e.entries, e.memory_mb, e.disk_mb, e.working_mb, span_text(e.wall_s),
        threads.count(), threads.count() == 1 ? "" : "s", sample_text(e.sample, config));
}

}  // namespace vfplan
