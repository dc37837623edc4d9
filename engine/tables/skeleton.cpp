#include "engine/tables/skeleton.h"

#include "kernels/distance.h"
#include "kernels/index.h"
#include "kernels/skeleton.h"

namespace vfplan {
namespace {

// The skeleton cells of a window; false when what lies around it was too little to tell.
bool thin_window(const Threads& threads, const FieldTiles& tiles, double threshold_rad,
                 const Window& core, const Window& around, SkeletonCells& out) {
    const Grid& grid = tiles.layout().grid;
    const FieldWindow field = tiles.window(around);
    const Raster<std::uint8_t> domain = field.domain(threshold_rad);
    DistanceField distance;
    distance.resize(field.grid.size());
    threads.for_each(field.grid.nx, 64, [&](std::int64_t from, std::int64_t to) {
        distance_columns(field.grid, domain, static_cast<std::int32_t>(from),
                         static_cast<std::int32_t>(to), distance);
    });
    threads.for_each(field.grid.ny, 64, [&](std::int64_t from, std::int64_t to) {
        distance_rows(field.grid, domain, static_cast<std::int32_t>(from),
                      static_cast<std::int32_t>(to), distance);
    });
    PartOfGrid part{
        around.x_begin,
        around.y_begin,
        {around.x_begin > 0, around.y_begin > 0, around.x_end < grid.nx, around.y_end < grid.ny}};
    const std::vector<Cell> state = thin(field.grid, domain, distance, part);
    out = {};
    for (std::int32_t y = core.y_begin; y < core.y_end; ++y) {
        for (std::int32_t x = core.x_begin; x < core.x_end; ++x) {
            const std::size_t i = field.index(x, y);
            if (state[i] == Cell::unknown) return false;
            if (state[i] == Cell::absent) continue;
            out.cell.push_back(grid.id(x, y));
            out.squared.push_back(distance.squared[i]);
        }
    }
    return true;
}

}  // namespace

double skeleton_task_bytes(const Layout& layout, double range_cells) {
    constexpr double cell_bytes = 32;  // field, domain, distances, states and what waits in line
    return cell_bytes * layout.largest_window_cells(range_cells + skeleton_margin_cells);
}

SkeletonTiles make_skeleton(const TableJob& job, const FieldTiles& field, double threshold_rad) {
    const Layout& layout = job.layout();
    const ShardNames names = job.passing("skeleton");
    make_shards(
        job, names, layout.tiles(),
        [&](std::int64_t tile, const std::filesystem::path& path) {
            const Window core = layout.tile_window(tile);
            SkeletonCells cells;
            // Walls are nearer than the range to every cell of the domain.
            std::int32_t margin = job.range_cells() + skeleton_margin_cells;
            while (!thin_window(job.threads, field, threshold_rad, core,
                                core.grown(margin, layout.grid), cells)) {
                margin *= 2;
            }
            write_skeleton_tile(path, job.key, cells);
        },
        skeleton_task_bytes(layout, job.range_cells()));
    return {layout, names};
}

RidgeTiles make_ridges(const TableJob& job, const SkeletonTiles& skeleton) {
    const Layout& layout = job.layout();
    const ShardNames names = job.passing("ridges");
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        SkeletonCells cells = skeleton.all();
        prune_spurs(layout.grid, cells);
        write_ridges(path, job.key, layout, ridge_graph(layout.grid, cells));
    });
    return {layout, names.whole()};
}

}  // namespace vfplan
