#include "engine/job/estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/config/options.h"
#include "engine/job/sample.h"
#include "engine/tables/site.h"
#include "io/exports/outputs.h"
#include "kernels/coverage.h"

namespace vfplan {
namespace {

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
    double sum = 0;
    for (const Output& o : outputs()) {
        if (std::find(formats.begin(), formats.end(), o.format) == formats.end()) continue;
        sum +=
            (o.*cost).of(static_cast<double>(e.pieces), static_cast<double>(e.candidates), pixels);
    }
    return sum;
}

double files_mb(const Config& config, const Estimate& e, double walls) {
    const double tables =
        8 * static_cast<double>(e.pieces) + 25 * static_cast<double>(e.candidates) + 40 * walls;
    return (tables + outputs_take(config, e, &Output::bytes)) / 1e6;
}

double files_s(const Config& config, const Estimate& e) {
    return 1e-6 * static_cast<double>(e.pieces) + 1.5e-9 * static_cast<double>(e.cells) +
           outputs_take(config, e, &Output::seconds);
}

double tables_memory_mb(const Config& config, const Estimate& e, const Threads& threads) {
    const double tile = static_cast<double>(config.field.tile_cells);
    const double cells =
        std::min(static_cast<double>(e.cells),
                 std::pow(tile + 2 * config.scanner.range_max_m / config.field.cell_m + 100, 2));
    const double share = cells / static_cast<double>(std::max<std::int64_t>(1, e.cells));
    const double rows = static_cast<double>(e.entries) * share * 24;
    const double lanes = std::min<double>(threads.count(), std::ceil(1 / share));
    return lanes * (cells * 32 + rows) / 1e6;
}

}  // namespace

Estimate estimate(const Config& config, const Threads& threads, Progress& progress) {
    const GroundOptions ground = ground_options(config);
    const Moment begin = Moment::now();
    const Site site = read_ground(ground, threads, progress);
    const double site_s = Moment::now().wall_s - begin.wall_s;
    const Layout layout = layout_of(ground, site);
    Estimate e;
    e.cells = layout.grid.size();
    for (const auto& bits : standable_bits(ground, site, layout, threads)) {
        for (const std::uint8_t byte : bits) e.free_cells += std::popcount(byte);
    }
    e.pieces = cut_into_pieces(site.walls, ground.partition_m).size();
    const double site_mb = progress.peak_rss_mb();
    progress.stage("sample");
    const Sample s = try_squares(ground, table_options(config), site, threads);
    e.whole = s.whole;
    e.candidates = static_cast<std::int64_t>(s.candidates / s.share);
    e.entries = static_cast<std::int64_t>(s.entries / s.share);
    const auto walls = static_cast<double>(site.walls.size());
    // Libraries; and the picture in memory, a few times over.
    const double base_mb = 65 + outputs_take(config, e, &Output::memory_bytes) / 1e6;
    e.memory_mb = std::max({site_mb, base_mb + tables_memory_mb(config, e, threads),
                            base_mb + plan_memory_mb(e, walls)});
    e.disk_mb = (s.field_bytes + s.coverage_bytes) / s.share / 1e6 + files_mb(config, e, walls);
    e.working_mb = s.working_bytes / s.share / 1e6;
    const double plan_s = 3.5e-7 * static_cast<double>(e.entries);
    constexpr double serial = 0.12;  // of the tables: what the leader does alone
    e.wall_s = site_s + s.cpu_s / s.share * (serial + (1 - serial) / threads.count()) + plan_s +
               files_s(config, e) + 0.2;
    progress.finish();
    return e;
}

std::string estimate_text(const Estimate& e, const Config& config, const Threads& threads) {
    const auto span = [](double s) {
        return s < 90 ? fmt::format("{:.2g} s", s) : fmt::format("{:.0f} min", std::ceil(s / 60));
    };
    return fmt::format(
        "cells        {} of {} m, {} of them free\n"
        "pieces       {}\n"
        "candidates   about {}, which see {} pieces in all\n"
        "memory       about {:.0f} MB a process\n"
        "disk         about {:.0f} MB, and {:.0f} MB more while it runs\n"
        "time         about {} with {} thread{}\n"
        "The job is valid; nothing was written.\n",
        e.cells, config.field.cell_m, e.free_cells, e.pieces, e.candidates, e.entries, e.memory_mb,
        e.disk_mb, e.working_mb, span(e.wall_s), threads.count(), threads.count() == 1 ? "" : "s");
}

}  // namespace vfplan
