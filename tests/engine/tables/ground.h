// Small sites for the tests of candidates: walls, a field, ridges drawn by hand.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/job/tables.h"
#include "engine/tables/field.h"
#include "engine/tables/skeleton.h"
#include "io/tables/coverage_file.h"
#include "io/tables/path_shards.h"
#include "kernels/free_cells.h"
#include "kernels/skeleton.h"
#include "tests/io/site/features.h"
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

// What coverage.h5 holds.
struct CandidateResult {
    std::vector<Candidate> candidates;
    CoverageTable table;
    std::vector<PieceStatus> status;
    // Of the search, as summary.json has them.
    std::int64_t joints = 0;
    std::int64_t ridges = 0;
    std::int64_t arcs_short_of_overlap = 0;
    std::int64_t rescued_pieces = 0;
    std::int64_t components_before = 0;
    std::int64_t components = 0;
    std::size_t paths = 0;  // between components, that were tried
};
inline CandidateResult read_result(const std::filesystem::path& file) {
    const CoverageTables tables = read_coverage(file);
    const CoverageEntries entries(file);
    const auto pieces = entries.pieces(0, tables.entries());
    const auto fractions = entries.fractions(0, tables.entries());
    const auto angles = entries.angles_rad(0, tables.entries());
    CandidateResult out;
    out.candidates = tables.candidates;
    out.status = tables.status;
    out.table.begin = tables.begin;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        out.table.seen.push_back({pieces[i], fractions[i], angles[i]});
    }
    const auto search = nlohmann::json::parse(tables.summary).at("candidate_search");
    search.at("joints").get_to(out.joints);
    search.at("ridges").get_to(out.ridges);
    search.at("arcs_short_of_overlap").get_to(out.arcs_short_of_overlap);
    search.at("rescued_pieces").get_to(out.rescued_pieces);
    search.at("components_before_connectors").get_to(out.components_before);
    search.at("components").get_to(out.components);
    return out;
}

// To the last bit.
inline void expect_same(const CandidateResult& a, const CandidateResult& b) {
    ASSERT_EQ(a.candidates.size(), b.candidates.size());
    for (std::size_t i = 0; i < a.candidates.size(); ++i) {
        const Candidate& p = a.candidates[i];
        const Candidate& q = b.candidates[i];
        ASSERT_EQ(std::tuple(p.at.x(), p.at.y(), p.cell, p.kind, p.vf_rad),
                  std::tuple(q.at.x(), q.at.y(), q.cell, q.kind, q.vf_rad));
    }
    EXPECT_EQ(a.table.begin, b.table.begin);
    ASSERT_EQ(a.table.seen.size(), b.table.seen.size());
    for (std::size_t i = 0; i < a.table.seen.size(); ++i) {
        const Seen& p = a.table.seen[i];
        const Seen& q = b.table.seen[i];
        ASSERT_EQ(std::tuple(p.piece, p.fraction, p.angle_rad),
                  std::tuple(q.piece, q.fraction, q.angle_rad));
    }
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.arcs_short_of_overlap, b.arcs_short_of_overlap);
    EXPECT_EQ(a.rescued_pieces, b.rescued_pieces);
    EXPECT_EQ(a.components_before, b.components_before);
    EXPECT_EQ(a.components, b.components);
}

// A skeleton, and its joints and ridges.
struct Lines : RidgeGraph {
    SkeletonCells cells;
};

// A run directory and a job in it, for calling the phases one by one.
class Job {
public:
    Job(const TableOptions& o, const std::filesystem::path& site_file, int thread_count = 1)
        : options(o),
          threads(thread_count),
          site(site_file, o.tile_cells),
          scenes(
              site.layout(), [this](std::int64_t patch) { return site.patch(patch); }, o.scenes,
              64) {
        make_shard_folders(dir, o.tile_cells);
    }
    Job(const Job&) = delete;
    Job& operator=(const Job&) = delete;

    FieldTiles field() const { return make_field(tables, site); }
    // Gives the field's tiles without looking.
    FieldTiles put_field(const Raster<float>& vf_rad, const Raster<std::uint8_t>& closed) const {
        const Layout& layout = tables.layout();
        const ShardNames names = tables.kept("field", fmt::format("-{}", layout.tile_cells));
        const Window whole{0, 0, layout.grid.nx, layout.grid.ny};
        for (std::int64_t t = 0; t < layout.tiles(); ++t) {
            FieldTile tile;
            tile.window = layout.tile_window(t);
            tile.vf_rad.resize(static_cast<std::size_t>(tile.window.size()));
            tile.closed.resize(tile.vf_rad.size());
            copy_shared(whole, vf_rad, tile.window, tile.vf_rad);
            copy_shared(whole, closed, tile.window, tile.closed);
            write_field_tile(names.one(t), key, tile);
        }
        return field();
    }
    // Takes a skeleton apart that nobody thinned.
    RidgeTiles put_skeleton(const SkeletonCells& cells) const {
        const Layout& layout = tables.layout();
        const ShardNames names = tables.passing("skeleton");
        std::vector<SkeletonCells> of_tile(static_cast<std::size_t>(layout.tiles()));
        for (std::size_t i = 0; i < cells.cell.size(); ++i) {
            auto& to = of_tile[static_cast<std::size_t>(layout.tile_of(cells.cell[i]))];
            to.cell.push_back(cells.cell[i]);
            to.squared.push_back(cells.squared[i]);
        }
        for (std::size_t t = 0; t < of_tile.size(); ++t) {
            write_skeleton_tile(names.one(static_cast<std::int64_t>(t)), key, of_tile[t]);
        }
        return make_ridges(tables, {layout, names});
    }
    CandidateResult candidates(const FieldTiles& field, const RidgeTiles& ridges) const {
        make_coverage_table(tables, site, field, ridges, options);
        CandidateResult out = read_result(dir / "coverage.h5");
        const std::filesystem::path paths = tables.passing("paths").whole();
        if (std::filesystem::exists(paths)) out.paths = read_paths(paths).size();
        return out;
    }

private:
    inline static int jobs_ = 0;
    TemporaryFolder folder_{fmt::format("job{}", jobs_++)};

public:
    const TableOptions options;
    const std::filesystem::path dir = folder_.path();
    const std::string key = "key";
    const Threads threads;
    const Ranks ranks;
    mutable Progress progress{true};
    const SiteStore site;
    mutable Scenes scenes;
    const TableJob tables{dir, key, threads, ranks, progress, scenes};
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
        standable = free_cells(grid, border_of(rings));
        write_store(box);
        const Job job(options({}), site_.path());
        FieldWindow whole = job.field().window(whole_grid());
        field = std::move(whole.vf_rad);
        closed = std::move(whole.closed);
        store_ = std::make_unique<SiteStore>(site_.path(), s.tile_cells);
        scenes_ = std::make_unique<Scenes>(
            layout, [this](std::int64_t patch) { return store_->patch(patch); }, options({}).scenes,
            64);
    }

    World(const World&) = delete;  // its scenes refer to its store
    World& operator=(const World&) = delete;

    Window whole_grid() const { return {0, 0, grid.nx, grid.ny}; }
    std::int64_t cell(double x, double y) const {
        const Vec2d at = (Vec2d(x, y) - grid.origin) / grid.cell_m;
        return grid.id(static_cast<std::int32_t>(std::floor(at.x())),
                       static_cast<std::int32_t>(std::floor(at.y())));
    }
    bool free_at(const Vec2d& p) const { return inside_odd(border_of(outline), p); }
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

    TableOptions options(const CandidateOptions& o) const {
        TableOptions out;
        out.scenes.scanner = setting.scanner;
        out.scenes.partition_m = setting.partition_m;
        out.scenes.visible_fraction = setting.visible_fraction;
        out.tile_cells = setting.tile_cells;
        out.threshold_rad = setting.threshold_rad;
        out.overlap = {o.ratio, o.threshold};
        out.required = o.required;
        out.existing = o.existing;
        return out;
    }
    CandidateResult candidates(const Lines& lines, const CandidateOptions& o = {},
                               int threads = 1) const {
        const Job job(options(o), site_.path(), threads);
        Raster<float> vf = field;
        for (std::size_t i = 0; i < vf.size(); ++i) {
            if (standable[i] == 0) vf[i] = std::nanf("");
        }
        const FieldTiles tiles = job.put_field(vf, closed);
        return job.candidates(tiles, job.put_skeleton(lines.cells));
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
        const double reach_m =
            wall_reach_m(setting.scanner.range_max_m, setting.partition_m, 0.001);
        write_site_store(site_.path(), "key", layout, facts, walls, pieces,
                         near_walls(layout, walls, reach_m), bits);
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
