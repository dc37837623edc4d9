#include "engine/tables/field.h"

#include <fmt/format.h>

#include <limits>

#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int32_t threads_window = 32;  // side of the windows that threads take, cells

// VF of the cells of a patch that lie in the tile.
FieldCounts field_of_patch(const TableJob& job, const SiteStore& site, std::int64_t patch,
                           const Window& tile, Raster<float>& vf_rad) {
    const Window whole = job.layout().patch_window(patch);
    const Window wanted = shared(whole, tile);
    const Raster<std::uint8_t> standable = site.standable(patch);
    Raster<float> out(standable.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = standable[i] != 0 ? 0.0F : std::numeric_limits<float>::quiet_NaN();
    }
    FieldCounts counts;
    if (site.has_walls(patch)) {
        const std::shared_ptr<const Scene> scene = job.scenes.of_patch(patch);
        Threads::apart([&] { scene->take_rays_enough(standable); });
        std::vector<Window> windows;
        for (std::int32_t y = whole.y_begin; y < whole.y_end; y += threads_window) {
            for (std::int32_t x = whole.x_begin; x < whole.x_end; x += threads_window) {
                const Window w = shared(wanted, {x, y, x + threads_window, y + threads_window});
                if (w.x_begin >= w.x_end || w.y_begin >= w.y_end) continue;
                windows.push_back({w.x_begin - whole.x_begin, w.y_begin - whole.y_begin,
                                   w.x_end - whole.x_begin, w.y_end - whole.y_begin});
            }
        }
        std::vector<FieldCounts> each(windows.size());
        job.threads.for_each(static_cast<std::int64_t>(windows.size()), 1,
                             [&](std::int64_t from, std::int64_t to) {
                                 for (std::int64_t i = from; i < to; ++i) {
                                     each[idx(i)] = scene->field(windows[idx(i)], standable, out);
                                 }
                             });
        for (const FieldCounts& c : each) counts += c;
    }
    copy_shared(whole, out, tile, vf_rad);
    return counts;
}

// Closed links of a tile's cells. Each link is looked at in the frame of the patch that owns it, so
// that both its ends agree, in whatever tiles they lie.
Raster<std::uint8_t> closed_of_tile(const TableJob& job, const SiteStore& site,
                                    const Window& tile) {
    const Layout& layout = job.layout();
    const Window around = tile.grown(1, layout.grid);
    Raster<std::uint8_t> out(idx(around.size()), 0);
    const Grid around_grid = part_of(layout.grid, around);
    for (const std::int64_t patch : layout.patches_in(around)) {
        if (!site.has_walls(patch)) continue;
        const Window owners = shared(layout.patch_window(patch), around);
        const Window looked_at = owners.grown(1, layout.grid);
        const Window patch_window = layout.patch_window(patch);
        PatchSite near = site.patch(patch);
        const Vec2d origin = layout.patch_origin(patch);
        for (Wall& wall : near.walls) {
            wall.a -= origin;
            wall.b -= origin;
        }
        const double cell = layout.grid.cell_m;
        const Grid grid{{cell * (looked_at.x_begin - patch_window.x_begin),
                         cell * (looked_at.y_begin - patch_window.y_begin)},
                        cell,
                        looked_at.x_end - looked_at.x_begin,
                        looked_at.y_end - looked_at.y_begin};
        const Raster<std::uint8_t> closed =
            closed_steps(grid, site.standable(looked_at), near.walls,
                         {owners.x_begin - looked_at.x_begin, owners.y_begin - looked_at.y_begin,
                          owners.x_end - looked_at.x_begin, owners.y_end - looked_at.y_begin});
        for (std::int32_t y = looked_at.y_begin; y < looked_at.y_end; ++y) {
            for (std::int32_t x = looked_at.x_begin; x < looked_at.x_end; ++x) {
                if (!around.contains(x, y)) continue;
                auto& to = out[idx(around_grid.id(x - around.x_begin, y - around.y_begin))];
                to = static_cast<std::uint8_t>(
                    to | closed[idx(grid.id(x - looked_at.x_begin, y - looked_at.y_begin))]);
            }
        }
    }
    Raster<std::uint8_t> inner(idx(tile.size()));
    copy_shared(around, out, tile, inner);
    return inner;
}

}  // namespace

double field_task_bytes(const Layout& layout) {
    // A float and a byte of a patch and of the tile, and what of it is closed.
    return 5 * layout.largest_patch_cells() + 8 * layout.largest_window_cells(0);
}

FieldTiles make_field(const TableJob& job, const SiteStore& site) {
    const Layout& layout = job.layout();
    const ShardNames names = job.kept("field", fmt::format("-{}", layout.tile_cells));
    make_shards(
        job, names, layout.tiles(),
        [&](std::int64_t number, const std::filesystem::path& path) {
            FieldTile tile;
            tile.window = layout.tile_window(number);
            tile.vf_rad.resize(idx(tile.window.size()));
            for (const std::int64_t patch : layout.patches_in(tile.window)) {
                tile.counts += field_of_patch(job, site, patch, tile.window, tile.vf_rad);
            }
            // How many cells share a step depends on the processor, and equal jobs give
            // equal bytes.
            if (job.scenes.options().kernel == KernelKind::exact) {
                tile.counts = {tile.counts.cells, 0, 0, 0};
            }
            tile.closed = closed_of_tile(job, site, tile.window);
            write_field_tile(path, job.key, tile);
        },
        field_task_bytes(layout));
    return {layout, names};
}

}  // namespace vfplan
