#include "engine/tables_stage.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>

#include "io/vector_reader.h"
#include "kernels/embree_scene.h"
#include "kernels/error.h"
#include "kernels/free_cells.h"
#include "kernels/skeleton.h"

namespace vfplan {
namespace {

// Bytes per cell: field, masks, distance with its two offsets, floods of the links.
constexpr double bytes_per_cell = 4 + 5 + 12 + 16;

std::vector<Ring> forbidden_rings(const Config& config, const Site& site) {
    if (config.plan.forbidden.empty()) return {};
    std::vector<Polygon> polygons;
    for (Feature& f : read_features(config.plan.forbidden,
                                    {SiteKind::outdoor, "", config.site.crs, config.site.unit_m})
                          .features) {
        each_point(f, [&](Vec2d& v) { v -= site.origin; });
        for (Polygon& p : f.polygons) polygons.push_back(std::move(p));
    }
    return rings_of_union(polygons, config.site.snap_m);
}

// Processor seconds per cell of the field, from windows spread over the grid.
double seconds_per_cell(const Config& config, const Prepared& p) {
    constexpr std::int32_t windows = 6;  // each way
    constexpr std::int32_t side = 16;    // cells
    const Scanner scanner = scanner_of(config);
    const auto kernel = make_kernel(config.visibility.kernel, p.site.walls, p.site.extent,
                                    scanner.range_max_m, rays_of(config));
    Raster<float> vf(p.standable.size());
    FieldCounts counts;
    const Moment begin = Moment::now();
    for (std::int32_t i = 0; i < windows * windows; ++i) {
        const auto corner = [&](std::int32_t k, std::int32_t n) {
            return (2 * k + 1) * n / (2 * windows) / window_step * window_step;
        };
        const std::int32_t x = corner(i % windows, p.grid.nx);
        const std::int32_t y = corner(i / windows, p.grid.ny);
        const Window w{x, y, std::min(x + side, p.grid.nx), std::min(y + side, p.grid.ny)};
        counts += kernel->field(scanner, p.grid, w, p.standable, vf);
    }
    return (Moment::now().cpu_s - begin.cpu_s) /
           static_cast<double>(std::max<std::int64_t>(1, counts.cells));
}

std::vector<Vec2d> in_site_frame(const std::vector<Vec2d>& points, const Site& site,
                                 const std::vector<Ring>& forbidden, const char* key) {
    std::vector<Vec2d> out;
    for (const Vec2d& point : points) {
        const Vec2d at = point - site.origin;
        const char* why = nullptr;
        if (!site.extent.contains(at) || !inside_odd(site.free_region, at)) {
            why = "it is not in free space";
        } else if (inside_odd(forbidden, at)) {
            why = "plan.forbidden covers it";
        }
        if (why != nullptr) {
            throw UsageError(
                fmt::format("{}: no station can stand at ({}, {}): {}; give a point in "
                            "the coordinates of the site",
                            key, point.x(), point.y(), why));
        }
        out.push_back(at);
    }
    return out;
}

}  // namespace

SiteOptions site_options(const Config& c) {
    SiteOptions o;
    o.kind = c.site.kind == "indoor" ? SiteKind::indoor : SiteKind::outdoor;
    o.layer = c.site.layer;
    o.crs = c.site.crs;
    o.unit_m = c.site.unit_m;
    o.snap_m = c.site.snap_m;
    o.margin_m = c.site.margin_m;
    o.crop_m = c.site.crop_m;
    o.doors_open = c.site.doors == "open";
    o.windows = c.site.windows == "wall"     ? WindowMode::wall
                : c.site.windows == "ignore" ? WindowMode::ignore
                                             : WindowMode::opening;
    o.invalid = c.site.invalid == "error"    ? InvalidPolygons::error
                : c.site.invalid == "repair" ? InvalidPolygons::repair
                                             : InvalidPolygons::drop;
    return o;
}

Scanner scanner_of(const Config& c) {
    return {c.scanner.range_min_m, c.scanner.range_max_m, c.scanner.max_incidence_deg};
}

OverlapRatio ratio_of(const std::string& name) {
    const auto found = std::find(overlap_ratio_names.begin(), overlap_ratio_names.end(), name);
    return static_cast<OverlapRatio>(found - overlap_ratio_names.begin());
}

int rays_of(const Config& c) {
    if (c.visibility.rays > 0) return static_cast<int>(c.visibility.rays);
    return default_rays(c.scanner.range_max_m, c.coverage.partition_m);
}

Prepared prepare(const Config& config, Site site) {
    Prepared p;
    p.site = std::move(site);
    const Vec2d size = p.site.extent.size();
    const double cell = config.field.cell_m;
    if (cell > size.x() || cell > size.y()) {
        throw UsageError(
            fmt::format("field.cell_m = {}: a cell is larger than the site, which is "
                        "{:.1f} x {:.1f} m; choose a smaller one",
                        cell, size.x(), size.y()));
    }
    const double cells = std::ceil(size.x() / cell) * std::ceil(size.y() / cell);
    const double ram =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    if (cells > 2e9 || cells * bytes_per_cell > 0.9 * ram) {
        throw UsageError(
            fmt::format("field.cell_m = {}: {:.3g} cells need about {:.1f} GB and "
                        "this machine has {:.1f} GB; choose larger cells or crop_m",
                        cell, cells, cells * bytes_per_cell / 1e9, ram / 1e9));
    }
    p.grid = make_grid(p.site.extent, cell, config.site.snap_m);
    p.standable = free_cells(p.grid, p.site.free_region);
    const std::vector<Ring> forbidden = forbidden_rings(config, p.site);
    const Raster<std::uint8_t> kept_out = free_cells(p.grid, forbidden);
    const Raster<std::uint8_t> too_near =
        cells_near_walls(p.grid, p.site.walls, config.site.clearance_m);
    for (std::size_t i = 0; i < p.standable.size(); ++i) {
        if (kept_out[i] != 0 || too_near[i] != 0) p.standable[i] = 0;
    }
    if (std::count(p.standable.begin(), p.standable.end(), 1) == 0) {
        throw UsageError(
            fmt::format("field.cell_m = {}: no cell's centre lies in free space; "
                        "choose a smaller cell",
                        cell));
    }
    p.required = in_site_frame(config.plan.required, p.site, forbidden, "plan.required");
    p.existing = in_site_frame(config.plan.existing, p.site, {}, "plan.existing");
    return p;
}

Estimate estimate(const Config& config, const Prepared& p, const Threads& threads) {
    Estimate e;
    e.cells = p.grid.size();
    e.free_cells = std::count(p.standable.begin(), p.standable.end(), 1);
    e.pieces = cut_into_pieces(p.site.walls, config.coverage.partition_m).size();
    // Joints come about twice per building or room, ridge points as many again.
    e.candidates = std::max<std::int64_t>(4, 3 * p.site.buildings);
    const double entries =
        static_cast<double>(e.candidates) * std::min(400.0, static_cast<double>(e.pieces));
    e.memory_mb = (static_cast<double>(e.cells) * bytes_per_cell + entries * 24 +
                   static_cast<double>(p.site.walls.size()) * 400) /
                      1e6 +
                  60;
    e.disk_mb =
        (static_cast<double>(e.free_cells) * 3 + entries * 5 + static_cast<double>(e.pieces) * 80) /
            1e6 +
        1;
    e.field_s = seconds_per_cell(config, p) * static_cast<double>(e.free_cells) / threads.count();
    return e;
}

Tables make_tables(const Config& config, const Prepared& p, const std::string& key,
                   const Threads& threads, Progress& progress) {
    Tables out;
    const Scanner scanner = scanner_of(config);
    progress.stage("scene");
    CoverageTables& c = out.coverage;
    c.walls = p.site.walls;
    c.pieces = cut_into_pieces(p.site.walls, config.coverage.partition_m);
    // The field has millions of views and may come from rays. The few thousand views of candidates
    // carry what a plan promises, so they are always exact.
    std::unique_ptr<ViewKernel> of_field;
    std::unique_ptr<ViewKernel> exact;
    threads.run([&] {
        exact = make_kernel("exact", p.site.walls, p.site.extent, scanner.range_max_m, 0);
        if (config.visibility.kernel != "exact") {
            of_field = make_kernel(config.visibility.kernel, p.site.walls, p.site.extent,
                                   scanner.range_max_m, rays_of(config));
        }
    });
    const double fraction = config.coverage.visible_fraction;
    const Viewer viewer(*exact, p.site.walls, c.pieces, scanner, fraction);
    const Viewer field_viewer(of_field ? *of_field : *exact, p.site.walls, c.pieces, scanner,
                              fraction);

    progress.stage("field", p.grid.size());
    FieldResult field = visibility_field(field_viewer, threads, p.grid, p.standable,
                                         [&](std::int64_t n) { progress.advance(n); });
    out.field = {p.grid, std::move(field.vf_rad), p.site.origin, p.site.crs_wkt, key};

    progress.stage("skeleton");
    const Raster<std::uint8_t> closed = closed_links(p.grid, p.standable, p.site.walls);
    Raster<std::uint8_t> domain(closed.size(), 0);
    const auto threshold = static_cast<float>(config.field.threshold_rad);
    for (std::size_t i = 0; i < domain.size(); ++i) {
        domain[i] = p.standable[i] != 0 && closed[i] == 0 && out.field.vf_rad[i] >= threshold;
    }
    DistanceField distance;
    distance.resize(p.grid.size());
    threads.for_each(p.grid.nx, 16, [&](std::int64_t from, std::int64_t to) {
        distance_columns(p.grid, domain, static_cast<std::int32_t>(from),
                         static_cast<std::int32_t>(to), distance);
    });
    threads.for_each(p.grid.ny, 16, [&](std::int64_t from, std::int64_t to) {
        distance_rows(p.grid, domain, static_cast<std::int32_t>(from),
                      static_cast<std::int32_t>(to), distance);
    });
    Raster<std::uint8_t> skeleton = thin(p.grid, domain, distance);
    prune_spurs(p.grid, distance, skeleton);
    const RidgeGraph ridges = ridge_graph(p.grid, skeleton);
    if (ridges.joints.empty() && ridges.ridges.empty() && p.required.empty() &&
        p.existing.empty()) {
        throw UsageError(fmt::format(
            "field.threshold_rad = {}: no cell sees that much wall between range_min_m = {} and "
            "range_max_m = {}; lower the threshold or raise range_max_m",
            config.field.threshold_rad, scanner.range_min_m, scanner.range_max_m));
    }

    const Ground ground{p.grid, out.field.vf_rad, p.standable, closed, domain};
    CandidateOptions options;
    options.ratio = ratio_of(config.overlap.ratio);
    options.threshold = config.overlap.threshold;
    options.required = p.required;
    options.existing = p.existing;
    CandidateResult found = find_candidates(viewer, threads, ground, ridges, options,
                                            [&](const char* phase) { progress.stage(phase); });
    c.reach = std::move(found.reach);
    c.candidates = std::move(found.candidates);
    c.table = std::move(found.table);
    c.origin = p.site.origin;
    c.crs_wkt = p.site.crs_wkt;
    c.key = key;
    out.report = found.report;
    out.counts = field.counts;
    return out;
}

}  // namespace vfplan
