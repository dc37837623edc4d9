// Small sites for the tests of candidates: walls, a field, ridges drawn by hand.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/candidate_tiles.h"
#include "engine/coverage_blocks.h"
#include "engine/field_tiles.h"
#include "engine/graph.h"
#include "engine/links.h"
#include "engine/skeleton_tiles.h"
#include "engine/tables_stage.h"
#include "io/tables.h"
#include "kernels/free_cells.h"
#include "kernels/skeleton.h"
#include "tests/io/features.h"
#include "tests/kernels/scenes.h"

namespace vfplan::test {

// A counter-clockwise ring of walls with free space inside; `points` as x, y pairs.
inline Ring ring_of(const std::vector<std::pair<double, double>>& points) {
    Ring ring;
    for (const auto& [x, y] : points) ring.emplace_back(x, y);
    return ring;
}

// What differs between two searches on one site.
struct CandidateOptions {
    double threshold = 0.3;
    OverlapRatio ratio = OverlapRatio::mean_len;
    std::vector<Vec2d> required;
    std::vector<Vec2d> existing;
};

struct CandidateResult {
    std::vector<Candidate> candidates;
    CoverageTable table;
    std::vector<PieceStatus> reach;
    CandidateReport report;
};

// A skeleton, and its joints and ridges.
struct Lines : RidgeGraph {
    SkeletonCells cells;
};

// A run directory and a Work in it, for calling the phases one by one.
class Job {
public:
    Job(const Config& c, const std::filesystem::path& site, int thread_count = 1)
        : config(c),
          threads(thread_count),
          store(site, c.field.tile_cells),
          scenes(
              store.layout(), [this](std::int64_t patch) { return store.patch(patch); },
              scene_options(config), 64) {
        std::filesystem::create_directories(dir / "shards");
        std::filesystem::create_directories(work.passing("any", 0).parent_path());
    }
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;

    // Gives the field's tiles without looking.
    void put_field(const Raster<float>& vf_rad, const Raster<std::uint8_t>& closed) const {
        const Layout& layout = work.layout();
        for (std::int64_t t = 0; t < layout.tiles(); ++t) {
            const Window w = layout.tile_window(t);
            Raster<float> vf;
            Raster<std::uint8_t> links;
            for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
                for (std::int32_t x = w.x_begin; x < w.x_end; ++x) {
                    const auto i = static_cast<std::size_t>(layout.grid.id(x, y));
                    vf.push_back(vf_rad[i]);
                    links.push_back(closed[i]);
                }
            }
            const h5::Dims shape = {static_cast<std::uint64_t>(w.y_end - w.y_begin),
                                    static_cast<std::uint64_t>(w.x_end - w.x_begin)};
            h5::Writer file = shard_writer(field_shard(dir, layout, t), key);
            file.write("vf", vf, shape);
            file.write("closed", links, shape);
            finish_shard(file);
        }
    }
    // Gives a skeleton without thinning, and takes it apart.
    void put_skeleton(const SkeletonCells& cells) const {
        const Layout& layout = work.layout();
        std::vector<SkeletonCells> of_tile(static_cast<std::size_t>(layout.tiles()));
        for (std::size_t i = 0; i < cells.cell.size(); ++i) {
            auto& to = of_tile[static_cast<std::size_t>(layout.tile_of(cells.cell[i]))];
            to.cell.push_back(cells.cell[i]);
            to.squared.push_back(cells.squared[i]);
        }
        for (std::size_t t = 0; t < of_tile.size(); ++t) {
            h5::Writer file =
                shard_writer(work.passing("skeleton", static_cast<std::int64_t>(t)), key);
            file.write("cell", of_tile[t].cell);
            file.write("squared", of_tile[t].squared);
            finish_shard(file);
        }
        make_ridge_graph(work, false);
    }
    // The phases between ridges and the coverage table.
    CandidateResult candidates() const {
        make_seeds(work);
        make_ridge_points(work);
        make_rescue(work);
        CandidateResult out;
        add_candidate_counts(work, out.report);
        out.report.rescued_pieces = rescued_pieces(work);
        make_links(work, out.report);
        write_coverage_tables(work, make_coverage_blocks(work), "{}");
        const CoverageTables tables = read_coverage(dir / "coverage.h5");
        const CoverageEntries entries(dir / "coverage.h5");
        const auto pieces = entries.pieces(0, tables.entries());
        const auto fractions = entries.fractions(0, tables.entries());
        const auto angles = entries.angles_rad(0, tables.entries());
        out.candidates = tables.candidates;
        out.reach = tables.reach;
        out.table.begin = tables.begin;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            out.table.seen.push_back({pieces[i], fractions[i], angles[i]});
        }
        return out;
    }

private:
    inline static int jobs_ = 0;
    TemporaryFolder folder_{fmt::format("job{}", jobs_++)};

public:
    const Config config;
    const std::filesystem::path dir = folder_.path();
    const std::string key = "key";
    const Threads threads;
    const Ranks ranks;
    mutable Progress progress{true};
    const SiteStore store;
    mutable Scenes scenes;
    const Work work{config, dir, key, threads, ranks, progress, store, scenes};
};

struct World {
    struct Setting {
        Scanner scanner{0.1, 100, 90};
        double cell_m = 1;
        double partition_m = 1;
        double visible_fraction = 0.5;
        double threshold_rad = 0;
        bool scanned = true;  // false: walls that are no pieces
        std::int64_t tile_cells = 256;
    };

    // The rings are walls and the even-odd bounds of free space; `partitions` are walls in it.
    World(const Setting& s, const std::vector<Ring>& rings,
          const std::vector<Wall>& partitions = {})
        : setting(s), outline(rings), walls(partitions) {
        for (const Ring& ring : rings) add_ring(walls, ring);
        for (Wall& wall : walls) wall.scanned = s.scanned;
        const Box box = bounds_of(walls);
        grid = make_grid(box, s.cell_m, 0.001);
        layout = make_layout(grid, s.scanner.range_max_m, s.tile_cells);
        pieces = cut_into_pieces(walls, s.partition_m);
        standable = free_cells(grid, rings);
        write_store(box);
        const Job job(config({}), site_.path());
        make_field_tiles(job.work);
        FieldWindow whole = read_field_window(job.dir, layout, whole_grid());
        field = std::move(whole.vf_rad);
        closed = std::move(whole.closed);
        store_ = std::make_unique<SiteStore>(site_.path(), s.tile_cells);
        scenes_ = std::make_unique<Scenes>(
            layout, [this](std::int64_t patch) { return store_->patch(patch); },
            scene_options(config({})), 64);
    }

    World(const World&) = delete;  // its scenes refer to its store
    World& operator=(const World&) = delete;

    Window whole_grid() const { return {0, 0, grid.nx, grid.ny}; }
    std::int64_t cell(double x, double y) const {
        const Vec2d at = (Vec2d(x, y) - grid.origin) / grid.cell_m;
        return grid.id(static_cast<std::int32_t>(std::floor(at.x())),
                       static_cast<std::int32_t>(std::floor(at.y())));
    }
    bool free_at(const Vec2d& p) const { return inside_odd(outline, p); }
    CoverageRow row(const Vec2d& eye) const { return scenes_->look(eye).row; }
    CoverageRow row(std::int64_t c) const { return row(grid.centre(c)); }
    double vf_rad(const Vec2d& eye) const { return scenes_->look(eye).vf_rad; }
    Raster<std::uint8_t> domain() const {
        Raster<std::uint8_t> out(field.size());
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i] = standable[i] != 0 && closed[i] == 0 && field[i] > 0 &&
                     field[i] >= static_cast<float>(setting.threshold_rad);
        }
        return out;
    }

    // A skeleton: cells along lines between points, one step at a time.
    Lines drawn(const std::vector<std::vector<std::pair<double, double>>>& lines) const {
        std::vector<std::int64_t> cells;
        for (const auto& line : lines) {
            for (std::size_t i = 0; i < line.size(); ++i) {
                std::int64_t c = cell(line[i].first, line[i].second);
                cells.push_back(c);
                if (i + 1 == line.size()) break;
                const std::int64_t to = cell(line[i + 1].first, line[i + 1].second);
                while (c != to) {
                    const auto step = [](std::int32_t d) { return d == 0 ? 0 : d > 0 ? 1 : -1; };
                    c = grid.id(grid.ix(c) + step(grid.ix(to) - grid.ix(c)),
                                grid.iy(c) + step(grid.iy(to) - grid.iy(c)));
                    cells.push_back(c);
                }
            }
        }
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        const std::vector<std::int32_t> none(cells.size(), 0);  // no clearance: nothing is a spur
        return taken_apart({std::move(cells), none});
    }
    // The true one, thinned in one piece.
    Lines ridges() const {
        const Raster<std::uint8_t> of = domain();
        DistanceField distance;
        distance.resize(grid.size());
        distance_columns(grid, of, 0, grid.nx, distance);
        distance_rows(grid, of, 0, grid.ny, distance);
        const std::vector<Cell> state = thin(grid, of, distance);
        SkeletonCells cells;
        for (std::size_t i = 0; i < state.size(); ++i) {
            if (state[i] != Cell::present) continue;
            cells.cell.push_back(static_cast<std::int64_t>(i));
            cells.squared.push_back(distance.squared[i]);
        }
        prune_spurs(grid, cells);
        return taken_apart(std::move(cells));
    }

    Config config(const CandidateOptions& o) const {
        Config c;
        c.scanner.range_min_m = setting.scanner.range_min_m;
        c.scanner.range_max_m = setting.scanner.range_max_m;
        c.scanner.max_incidence_deg = setting.scanner.max_incidence_deg;
        c.field.cell_m = setting.cell_m;
        c.field.threshold_rad = setting.threshold_rad;
        c.field.tile_cells = setting.tile_cells;
        c.coverage.partition_m = setting.partition_m;
        c.coverage.visible_fraction = setting.visible_fraction;
        c.overlap.ratio = overlap_ratio_names[static_cast<std::size_t>(o.ratio)];
        c.overlap.threshold = o.threshold;
        c.plan.required = o.required;
        c.plan.existing = o.existing;
        return c;
    }
    std::unique_ptr<Job> job(const Lines& lines, const CandidateOptions& options = {},
                             int threads = 1) const {
        auto out = std::make_unique<Job>(config(options), site_.path(), threads);
        Raster<float> vf = field;
        for (std::size_t i = 0; i < vf.size(); ++i) {
            if (standable[i] == 0) vf[i] = std::nanf("");
        }
        out->put_field(vf, closed);
        out->put_skeleton(lines.cells);
        return out;
    }
    CandidateResult candidates(const Lines& lines, const CandidateOptions& options = {},
                               int threads = 1) const {
        return job(lines, options, threads)->candidates();
    }
    const std::filesystem::path& site_file() const { return site_.path(); }

    Setting setting;
    std::vector<Ring> outline;
    std::vector<Wall> walls;
    Grid grid;
    Layout layout;
    Pieces pieces;
    // What may be changed before a search.
    Raster<std::uint8_t> standable, closed;
    Raster<float> field;

private:
    Lines taken_apart(SkeletonCells cells) const {
        return {ridge_graph(grid, cells), std::move(cells)};
    }
    void write_store(const Box& extent) {
        std::vector<CellBits> bits;
        SiteFacts facts;
        for (std::int64_t p = 0; p < layout.patches(); ++p) {
            const Window w = layout.patch_window(p);
            bits.emplace_back((static_cast<std::size_t>(w.size()) + 7) / 8, 0);
            std::size_t i = 0;
            for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
                for (std::int32_t x = w.x_begin; x < w.x_end; ++x, ++i) {
                    if (standable[static_cast<std::size_t>(grid.id(x, y))] == 0) continue;
                    bits.back()[i / 8] =
                        static_cast<std::uint8_t>(bits.back()[i / 8] | 1U << i % 8);
                    ++facts.free_cells;
                }
            }
        }
        facts.summary = "{}";
        facts.walls = static_cast<std::int64_t>(walls.size());
        facts.pieces = pieces.size();
        facts.extent = extent;
        const double reach =
            setting.scanner.range_max_m + eye_margin_m(setting.partition_m) + 0.001;
        write_site_store(site_.path(), "key", layout, facts, walls, pieces,
                         near_walls(layout, walls, reach), bits);
    }

    inline static int worlds_ = 0;
    TemporaryFile site_{fmt::format("world{}.h5", worlds_++)};
    std::unique_ptr<SiteStore> store_;
    std::unique_ptr<Scenes> scenes_;
};

inline World hall(double length = 20, double width = 10, World::Setting setting = {}) {
    return {setting, {box_ring(0, 0, length, width)}};
}

inline CandidateOptions overlap_of(double threshold, OverlapRatio ratio = OverlapRatio::mean_len) {
    CandidateOptions o;
    o.threshold = threshold;
    o.ratio = ratio;
    return o;
}

// The cells of one kind, ascending.
inline std::vector<std::int64_t> cells_of(const std::vector<Candidate>& candidates,
                                          CandidateKind kind) {
    std::vector<std::int64_t> out;
    for (const Candidate& c : candidates) {
        if (c.kind == kind) out.push_back(c.cell);
    }
    std::sort(out.begin(), out.end());
    return out;
}

inline bool row_has(const CoverageRow& row, std::int64_t piece) {
    return std::any_of(row.begin(), row.end(), [&](const Seen& s) { return s.piece == piece; });
}

}  // namespace vfplan::test
