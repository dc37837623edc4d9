#include "engine/pool/pool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/pool/pricing.h"
#include "engine/pool/weights.h"
#include "engine/tables/coverage.h"
#include "io/sha256.h"
#include "io/tables/candidate_list.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"

namespace vfplan {
namespace {

constexpr std::int32_t square_points = 32;  // tried along a side of a square
constexpr std::int32_t shard_squares = 4;   // along a side of a shard's block

// Every so many cells a point, so that there are about `per_candidate` for each candidate.
std::int32_t step_for(std::int64_t free_cells, double per_candidate, std::int64_t candidates) {
    const double points =
        per_candidate * static_cast<double>(std::max<std::int64_t>(1, candidates));
    if (points <= 0) return 0;
    const double step = std::sqrt(static_cast<double>(free_cells) / points);
    return std::max(1, static_cast<std::int32_t>(std::lround(std::min(step, 1e6))));
}

// The blocks of squares that cover the grid.
struct Blocks {
    Grid grid;
    std::int32_t side = 1;  // of a square, in cells

    std::int32_t width() const { return side * shard_squares; }
    std::int64_t columns() const { return (grid.nx + width() - 1) / width(); }
    std::int64_t count() const { return columns() * ((grid.ny + width() - 1) / width()); }
    Window block(std::int64_t number) const {
        return square(static_cast<std::int32_t>(number % columns()) * width(),
                      static_cast<std::int32_t>(number / columns()) * width(), width());
    }
    std::vector<Window> squares(const Window& block) const {
        std::vector<Window> out;
        for (std::int32_t y = block.y_begin; y < block.y_end; y += side) {
            for (std::int32_t x = block.x_begin; x < block.x_end; x += side) {
                out.push_back(square(x, y, side));
            }
        }
        return out;
    }

private:
    Window square(std::int32_t x, std::int32_t y, std::int32_t cells) const {
        return {x, y, std::min(grid.nx, x + cells), std::min(grid.ny, y + cells)};
    }
};

void add_rows(const CellRows& from, Sparse& rows) {
    for (const std::vector<std::int32_t>& row : from.covers) {
        rows.to.insert(rows.to.end(), row.begin(), row.end());
        rows.end_list();
    }
}

class PoolMaking {
public:
    PoolMaking(const TableJob& job, const FieldTiles& field, const CoverageTables& axis,
               const PoolOptions& options)
        : job_(job), field_(field), axis_(axis) {
        const std::int64_t cells = field.counts().cells;
        grid_.tried = step_for(cells, options.tried, axis.rows());
        grid_.taken = step_for(cells, options.taken, axis.rows());
        blocks_ = {job.layout().grid, grid_.tried * square_points};
    }

    void run() {
        if (grid_.tried > 0) {
            find_points(1, grid_);
            find_points(2, grid_);
        }
        const ShardNames list = job_.passing("pool");
        make_one(job_, "pool", list.whole(), [&](const std::filesystem::path& path) {
            write_candidate_list(path, job_.key, job_.layout(), new_points());
        });
        const std::vector<std::filesystem::path> blocks =
            make_coverage(job_, field_, "pool", {list.whole(), job_.layout(), {}});
        make_one(job_, "pool", job_.dir / pool_name, [&](const std::filesystem::path& path) {
            write_pool_index(path, blocks, job_.key, axis_.pieces.size());
        });
    }

private:
    static std::string phase(const char* name, int round) {
        return std::string(name) + "-" + std::to_string(round);
    }

    void find_points(int round, const PoolGrid& grid) {
        const std::filesystem::path file = job_.passing(phase("weights", round)).whole();
        make_one(job_, phase("weights", round), file, [&](const std::filesystem::path& path) {
            write_weights(path, job_.key, weigh_pieces(rows_before(round), axis_.pieces.size()));
        });
        const std::vector<std::int64_t> weight = read_weights(file);
        make_shards(job_, points(round), blocks_.count(),
                    [&](std::int64_t number, const std::filesystem::path& path) {
                        write_pool_squares(path, job_.key,
                                           squares_of_block(number, round, grid, weight));
                    });
    }

    ShardNames points(int round) const { return job_.passing(phase("points", round)); }

    std::vector<PoolSquare> squares_of_block(std::int64_t number, int round, const PoolGrid& grid,
                                             const std::vector<std::int64_t>& weight) const {
        const Window block = blocks_.block(number);
        const FieldWindow field = field_.window(block.grown(grid.tried, job_.layout().grid));
        const std::vector<Window> squares = blocks_.squares(block);
        std::vector<PoolSquare> before;
        if (round > 1) before = read_pool_squares(points(round - 1).one(number));
        std::vector<PoolSquare> out(squares.size());
        job_.threads.for_each(static_cast<std::int64_t>(squares.size()), 1,
                              [&](std::int64_t from, std::int64_t to) {
                                  for (auto i = idx(from); i < idx(to); ++i) {
                                      out[i] = points_of(job_, field, squares[i], grid, weight,
                                                         round > 1 ? &before[i].again : nullptr);
                                  }
                              });
        return out;
    }

    // Rows of the axis, and of the points of the rounds before.
    Sparse rows_before(int round) const {
        Sparse out{axis_.begin,
                   CoverageEntries(job_.dir / coverage_name).pieces(0, axis_.entries())};
        for (int r = 1; r < round; ++r) each_shard(r, [&](const CellRows& c) { add_rows(c, out); });
        return out;
    }

    // Of both rounds, but for cells of the axis.
    std::vector<Candidate> new_points() const {
        std::vector<std::int64_t> taken;
        for (const Candidate& c : axis_.candidates) taken.push_back(c.cell);
        std::sort(taken.begin(), taken.end());
        std::vector<Candidate> out;
        for (int round = 1; grid_.tried > 0 && round <= 2; ++round) {
            each_shard(round, [&](const CellRows& c) {
                for (const std::int64_t cell : c.cell) {
                    if (std::binary_search(taken.begin(), taken.end(), cell)) continue;
                    out.push_back({job_.layout().grid.centre(cell), cell, CandidateKind::pool, 0});
                }
            });
        }
        return out;
    }

    template <class F>
    void each_shard(int round, const F& f) const {
        for (std::int64_t number = 0; number < blocks_.count(); ++number) {
            f(read_taken(points(round).one(number)));
        }
    }

    const TableJob& job_;
    const FieldTiles& field_;
    const CoverageTables& axis_;
    PoolGrid grid_;
    Blocks blocks_;
};

}  // namespace

std::string pool_key(const std::string& tables_key, const PoolOptions& options) {
    return sha256_of(fmt::format("pool 1\n{}\n{} {}\n", tables_key, options.tried, options.taken));
}

void make_pool(const std::filesystem::path& dir, const PoolOptions& options, const Threads& threads,
               const Ranks& ranks, Progress& progress) {
    progress.stage("pool");
    const CoverageTables t = read_coverage(dir / coverage_name);
    const std::string key = pool_key(t.key, options);
    ranks.lead([&] { have_table(dir / pool_name, key, progress); });  // gone after this, or good
    if (std::filesystem::exists(dir / pool_name)) return;
    const Layout layout = FieldFile(dir / "field.h5").info().layout;
    ranks.lead([&] { make_shard_folders(dir, layout.tile_cells); });
    const NearWalls near = near_walls(layout, t.walls,
                                      wall_reach_m(options.scenes.scanner.range_max_m,
                                                   options.scenes.partition_m, options.snap_m));
    Scenes scenes(
        layout, [&](std::int64_t patch) { return patch_site(t.walls, t.pieces, near, patch); },
        options.scenes, 8 + 8 * threads.count());
    const TableJob job{dir, key, threads, ranks, progress, scenes};
    const FieldTiles field(layout, job.kept("field", fmt::format("-{}", layout.tile_cells)));
    PoolMaking(job, field, t, options).run();
}

}  // namespace vfplan
