#include "engine/estimate.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/plan_stage.h"
#include "engine/site_stage.h"
#include "engine/tables_stage.h"
#include "io/tables.h"
#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr double square_cells = 320;  // side of a square that is tried, at least
constexpr int squares_tried = 6;

// A folder for temporary files that goes with its object.
class TemporaryFolder {
public:
    TemporaryFolder() {
        std::error_code error;
        std::filesystem::path base = std::filesystem::temp_directory_path(error);
        if (error) base = "/tmp";
        std::string name = (base / "vfplan-estimate-XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr) {
            throw IoError(
                fmt::format("{}: the folder cannot be created; free space there or set "
                            "TMPDIR",
                            name));
        }
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

// Walls of a site by the square that their middle lies in.
struct Squares {
    std::int64_t columns = 0;
    double side_m = 0;
    Vec2d origin{0, 0};
    std::vector<double> weight;  // wall length, m

    // Two ranges wide at least: in less, what lies at the edge would be most of it.
    Squares(const Site& site, double cell_m, double range_m)
        : side_m(std::max(square_cells * cell_m, 2 * range_m)) {
        origin = site.extent.min;
        const Vec2d size = site.extent.size();
        columns = static_cast<std::int64_t>(std::ceil(size.x() / side_m));
        const auto rows = static_cast<std::int64_t>(std::ceil(size.y() / side_m));
        weight.assign(at(columns * rows), 0);
        for (const Wall& w : site.walls) {
            const Vec2d p = ((w.a + w.b) / 2 - origin) / side_m;
            const auto x = static_cast<std::int64_t>(p.x());
            const auto y = static_cast<std::int64_t>(p.y());
            weight[at(std::min(y, rows - 1) * columns + std::min(x, columns - 1))] += w.length_m();
        }
    }
    // Systematic sampling: each square as often as its share of walls.
    std::vector<std::size_t> sample() const {
        double whole = 0;
        for (const double w : weight) whole += w;
        std::vector<std::size_t> out;
        double before = 0;
        int taken = 0;
        for (std::size_t i = 0; i < weight.size(); ++i) {
            before += weight[i];
            bool hit = false;
            while (taken < squares_tried && before >= whole * (taken + 0.5) / squares_tried) {
                ++taken;
                hit = true;
            }
            if (hit) out.push_back(i);
        }
        return out;
    }
    Box box(std::size_t square) const {
        const auto n = static_cast<std::int64_t>(square);
        const Vec2d lo = origin + side_m * Vec2d(static_cast<double>(n % columns),
                                                 static_cast<double>(n / columns));
        return {lo, lo + Vec2d(side_m, side_m)};
    }
};

// The part of a site in a box, with the walls that are in sight of it.
Site part_of_site(const Site& site, const Box& box, double range_m) {
    Site out = site;
    out.extent = {box.min.cwiseMax(site.extent.min), box.max.cwiseMin(site.extent.max)};
    const Vec2d reach(range_m, range_m);
    const Box around{out.extent.min - reach, out.extent.max + reach};
    const auto meets = [&](const Vec2d& lo, const Vec2d& hi) {
        return lo.x() <= around.max.x() && hi.x() >= around.min.x() && lo.y() <= around.max.y() &&
               hi.y() >= around.min.y();
    };
    std::erase_if(out.walls,
                  [&](const Wall& w) { return !meets(w.a.cwiseMin(w.b), w.a.cwiseMax(w.b)); });
    std::erase_if(out.free_region, [&](const Ring& ring) {
        Box b;
        for (const Vec2d& p : ring) b.add(p);
        return !meets(b.min, b.max);
    });
    return out;
}

// What some squares took.
struct Sample {
    double wall_length_m = 0;
    double cpu_s = 0;
    double candidates = 0;
    double entries = 0;
    double field_bytes = 0;
    double coverage_bytes = 0;  // shards with rows
    double working_bytes = 0;
    double free_cells = 0;
};

double bytes_below(const std::filesystem::path& folder, const std::string& prefix) {
    double sum = 0;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder)) {
        if (e.is_regular_file() && e.path().filename().string().starts_with(prefix)) {
            sum += static_cast<double>(e.file_size());
        }
    }
    return sum;
}

// Makes the tables of a part of the site and adds what they took.
void try_part(const Config& config, const Site& site, double wall_length_m, const Threads& threads,
              Sample& sum) {
    const TemporaryFolder folder;
    Config part = config;
    part.plan.required.clear();
    part.plan.existing.clear();
    const Ranks alone{Ranks::Alone{}};
    Progress quiet(true);
    std::filesystem::create_directories(folder.path() / "shards");
    std::filesystem::create_directories(folder.path() / "work");
    const Moment begin = Moment::now();
    store_site(part, "estimate", site, threads, folder.path() / "work" / "site.h5");
    make_tables(part, folder.path(), "estimate", threads, alone, quiet);
    sum.cpu_s += Moment::now().cpu_s - begin.cpu_s;
    const CoverageTables tables = read_coverage(folder.path() / "coverage.h5");
    const FieldFile field(folder.path() / "field.h5");
    field.each_band([&](const Window&, const Raster<float>& vf) {
        for (const float v : vf) sum.free_cells += std::isnan(v) ? 0 : 1;
    });
    sum.wall_length_m += wall_length_m;
    sum.candidates += static_cast<double>(tables.rows());
    sum.entries += static_cast<double>(tables.entries());
    sum.field_bytes += bytes_below(folder.path() / "shards", "field");
    sum.coverage_bytes += bytes_below(folder.path() / "shards", "coverage");
    sum.working_bytes += bytes_below(folder.path() / "work", "");
}

// Bytes and seconds that follow from counts, measured on a city of 25 km2 (docs/performance.md).
double plan_memory_mb(const Estimate& e, double walls) {
    // Rows and their index, lengths and marks of pieces, graph, walls, candidates.
    return (8.0 * static_cast<double>(e.entries) + 30.0 * static_cast<double>(e.pieces) +
            600.0 * static_cast<double>(e.candidates) + 90.0 * walls) /
           1e6;
}

bool wanted(const Config& config, const char* format) {
    const auto& f = config.output.formats;
    return std::find(f.begin(), f.end(), format) != f.end();
}

// Files beside the shards: bytes of a line or a row each, as they turn out on real sites.
double files_mb(const Config& config, const Estimate& e, double walls) {
    const auto pieces = static_cast<double>(e.pieces);
    const auto candidates = static_cast<double>(e.candidates);
    const auto pixels = static_cast<double>(config.output.map_px);
    double bytes = 8 * pieces + 25 * candidates + 40 * walls;  // coverage.h5 and plan.h5
    if (wanted(config, "csv")) bytes += 62 * pieces + 30 * candidates;
    if (wanted(config, "geojson")) bytes += 80 * candidates;
    if (wanted(config, "gpkg")) bytes += 1.5e5 + 190 * pieces + 120 * candidates;
    if (wanted(config, "png")) bytes += 0.8 * pixels * pixels;
    return bytes / 1e6;
}

// The picture is drawn by one thread, the package filled by one.
double files_s(const Config& config, const Estimate& e) {
    const auto pieces = static_cast<double>(e.pieces);
    const auto pixels = static_cast<double>(config.output.map_px);
    double seconds = 1e-6 * pieces + 1.5e-9 * static_cast<double>(e.cells);
    if (wanted(config, "gpkg")) seconds += 0.05 + 1e-5 * pieces;
    if (wanted(config, "png")) seconds += 2e-7 * pixels * pixels + 1e-6 * pieces;
    return seconds;
}

double tables_memory_mb(const Config& config, const Estimate& e, double entries_per_candidate,
                        const Threads& threads) {
    const double tile = static_cast<double>(config.field.tile_cells);
    const double cells =
        std::min(static_cast<double>(e.cells),
                 std::pow(tile + 2 * config.scanner.range_max_m / config.field.cell_m + 100, 2));
    const double share = cells / static_cast<double>(std::max<std::int64_t>(1, e.cells));
    const double rows = static_cast<double>(e.candidates) * share * entries_per_candidate * 24;
    const double lanes = std::min<double>(threads.count(), std::ceil(1 / share));
    return lanes * (cells * 32 + rows) / 1e6;
}

}  // namespace

Estimate estimate(const Config& config, const Threads& threads, Progress& progress) {
    // Libraries; and the picture in memory, a few times over.
    const double base_mb =
        65 + (wanted(config, "png") ? 12e-6 * std::pow(static_cast<double>(config.output.map_px), 2)
                                    : 0);
    const Moment begin = Moment::now();
    const Site site = read_job_site(config, threads, progress);
    const double site_s = Moment::now().wall_s - begin.wall_s;
    const Layout layout = layout_of(config, site);
    Estimate e;
    e.cells = layout.grid.size();
    for (const auto& bits : standable_bits(config, site, layout, threads)) {
        for (const std::uint8_t byte : bits) e.free_cells += std::popcount(byte);
    }
    e.pieces = cut_into_pieces(site.walls, config.coverage.partition_m).size();
    const double site_mb = progress.peak_rss_mb();
    progress.stage("sample");
    const Squares squares(site, config.field.cell_m, config.scanner.range_max_m);
    double wall_length_m = 0;
    for (const double w : squares.weight) wall_length_m += w;
    const std::vector<std::size_t> chosen = squares.sample();
    Sample s;
    e.whole = squares.weight.size() <= squares_tried;
    if (e.whole) {
        try_part(config, site, wall_length_m, threads, s);
    } else {
        for (const std::size_t square : chosen) {
            try_part(config, part_of_site(site, squares.box(square), config.scanner.range_max_m),
                     squares.weight[square], threads, s);
        }
    }
    // Squares stand for shares of walls, each for as much as another.
    const double scale = s.wall_length_m > 0 ? wall_length_m / s.wall_length_m : 1;
    e.candidates = static_cast<std::int64_t>(s.candidates * scale);
    e.entries = static_cast<std::int64_t>(s.entries * scale);
    const double per_candidate = s.candidates > 0 ? s.entries / s.candidates : 0;
    const auto walls = static_cast<double>(site.walls.size());
    e.memory_mb = std::max({site_mb, base_mb + tables_memory_mb(config, e, per_candidate, threads),
                            base_mb + plan_memory_mb(e, walls)});
    e.disk_mb = (s.field_bytes + s.coverage_bytes) * scale / 1e6 + files_mb(config, e, walls);
    e.working_mb = s.working_bytes * scale / 1e6;
    const double plan_s = 3.5e-7 * static_cast<double>(e.entries);
    constexpr double serial = 0.12;  // of the tables: what the leader does alone
    e.wall_s = site_s + s.cpu_s * scale * (serial + (1 - serial) / threads.count()) + plan_s +
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
        "candidates   about {}, with {} rows' entries\n"
        "memory       about {:.0f} MB a process\n"
        "disk         about {:.0f} MB, and {:.0f} MB more while it runs\n"
        "time         about {} with {} threads\n"
        "The job is valid; nothing was written.\n",
        e.cells, config.field.cell_m, e.free_cells, e.pieces, e.candidates, e.entries, e.memory_mb,
        e.disk_mb, e.working_mb, span(e.wall_s), threads.count());
}

}  // namespace vfplan
