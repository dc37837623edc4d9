#include "engine/field_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int32_t threads_window = 32;  // side of the windows that threads take, cells

// Copies the cells that two windows share from one raster to the other.
template <class T>
void copy_shared(const Window& from_window, const Raster<T>& from, const Window& to_window,
                 Raster<T>& to) {
    const std::int32_t x0 = std::max(from_window.x_begin, to_window.x_begin);
    const std::int32_t x1 = std::min(from_window.x_end, to_window.x_end);
    for (std::int32_t y = std::max(from_window.y_begin, to_window.y_begin);
         y < std::min(from_window.y_end, to_window.y_end); ++y) {
        const auto index = [&](const Window& w, std::int32_t x) {
            return static_cast<std::ptrdiff_t>(y - w.y_begin) * (w.x_end - w.x_begin) +
                   (x - w.x_begin);
        };
        std::copy(from.begin() + index(from_window, x0), from.begin() + index(from_window, x1),
                  to.begin() + index(to_window, x0));
    }
}

Window shared(const Window& a, const Window& b) {
    return {std::max(a.x_begin, b.x_begin), std::max(a.y_begin, b.y_begin),
            std::min(a.x_end, b.x_end), std::min(a.y_end, b.y_end)};
}

// VF of the cells of a patch that lie in the tile.
FieldCounts field_of_patch(const Work& work, std::int64_t patch, const Window& tile,
                           Raster<float>& vf_rad) {
    const Window whole = work.layout().patch_window(patch);
    const Window wanted = shared(whole, tile);
    const Raster<std::uint8_t> standable = work.store.standable(patch);
    Raster<float> out(standable.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = standable[i] != 0 ? 0.0F : std::numeric_limits<float>::quiet_NaN();
    }
    FieldCounts counts;
    if (work.store.has_walls(patch)) {
        const std::shared_ptr<const Scene> scene = work.scenes.of_patch(patch);
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
        work.threads.for_each(static_cast<std::int64_t>(windows.size()), 1,
                              [&](std::int64_t from, std::int64_t to) {
                                  for (std::int64_t i = from; i < to; ++i) {
                                      each[at(i)] = scene->field(windows[at(i)], standable, out);
                                  }
                              });
        for (const FieldCounts& c : each) counts += c;
    }
    copy_shared(whole, out, tile, vf_rad);
    return counts;
}

// Closed links of a tile's cells. Each link is looked at in the frame of the patch that owns it, so
// that both its ends agree, in whatever tiles they lie.
Raster<std::uint8_t> closed_of_tile(const Work& work, const Window& tile) {
    const Layout& layout = work.layout();
    const Window around = tile.grown(1, layout.grid);
    Raster<std::uint8_t> out(at(around.size()), 0);
    const Grid around_grid = part_of(layout.grid, around);
    for (const std::int64_t patch : layout.patches_in(around)) {
        if (!work.store.has_walls(patch)) continue;
        const Window owners = shared(layout.patch_window(patch), around);
        const Window looked_at = owners.grown(1, layout.grid);
        const Window patch_window = layout.patch_window(patch);
        PatchSite site = work.store.patch(patch);
        const Vec2d origin = layout.patch_origin(patch);
        for (Wall& wall : site.walls) {
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
            closed_links(grid, work.store.standable(looked_at), site.walls,
                         {owners.x_begin - looked_at.x_begin, owners.y_begin - looked_at.y_begin,
                          owners.x_end - looked_at.x_begin, owners.y_end - looked_at.y_begin});
        for (std::int32_t y = looked_at.y_begin; y < looked_at.y_end; ++y) {
            for (std::int32_t x = looked_at.x_begin; x < looked_at.x_end; ++x) {
                if (!around.contains(x, y)) continue;
                auto& to = out[at(around_grid.id(x - around.x_begin, y - around.y_begin))];
                to = static_cast<std::uint8_t>(
                    to | closed[at(grid.id(x - looked_at.x_begin, y - looked_at.y_begin))]);
            }
        }
    }
    Raster<std::uint8_t> inner(at(tile.size()));
    copy_shared(around, out, tile, inner);
    return inner;
}

}  // namespace

std::filesystem::path field_shard(const std::filesystem::path& dir, const Layout& layout,
                                  std::int64_t tile) {
    return dir / "shards" / fmt::format("field-{}-{:05}.h5", layout.tile_cells, tile);
}

void make_field_tiles(const Work& work) {
    const Layout& layout = work.layout();
    make_shards(
        work, "field", layout.tiles(),
        [&](std::int64_t tile) { return field_shard(work.dir, layout, tile); },
        [&](std::int64_t tile, const std::filesystem::path& path) {
            const Window window = layout.tile_window(tile);
            Raster<float> vf(at(window.size()));
            FieldCounts counts;
            for (const std::int64_t patch : layout.patches_in(window)) {
                counts += field_of_patch(work, patch, window, vf);
            }
            // How many cells share a step depends on the processor, and equal jobs give equal
            // bytes.
            if (work.config.visibility.kernel == "exact") counts = {counts.cells, 0, 0, 0};
            h5::Writer file = shard_writer(path, work.key);
            const h5::Dims shape = {static_cast<std::uint64_t>(window.y_end - window.y_begin),
                                    static_cast<std::uint64_t>(window.x_end - window.x_begin)};
            file.write("vf", vf, shape);
            file.write("closed", closed_of_tile(work, window), shape);
            file.attribute("closed", "meaning",
                           "bit k: a wall parts the cell from its neighbour k, counter-clockwise "
                           "from east");
            file.attribute("/", "x_begin", std::int64_t{window.x_begin});
            file.attribute("/", "y_begin", std::int64_t{window.y_begin});
            file.attribute("/", "cells", counts.cells);
            file.attribute("/", "packets", counts.packets);
            file.attribute("/", "steps", counts.steps);
            file.attribute("/", "walls", counts.walls);
            finish_shard(file);
        });
}

FieldCounts count_field(const Work& work) {
    FieldCounts all;
    for (std::int64_t tile = 0; tile < work.layout().tiles(); ++tile) {
        const h5::Reader file(field_shard(work.dir, work.layout(), tile));
        const auto number = [&](const char* name) {
            return static_cast<std::int64_t>(file.number("/", name));
        };
        all += {number("cells"), number("packets"), number("steps"), number("walls")};
    }
    return all;
}

bool FieldWindow::in_domain(std::size_t i, double threshold_rad) const {
    // Also with a threshold of 0 a cell must see something; NaN is never above.
    return closed[i] == 0 && vf_rad[i] > 0 && vf_rad[i] >= static_cast<float>(threshold_rad);
}

Raster<std::uint8_t> FieldWindow::domain(double threshold_rad) const {
    Raster<std::uint8_t> out(vf_rad.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = in_domain(i, threshold_rad) ? 1 : 0;
    return out;
}

FieldWindow read_field_window(const std::filesystem::path& dir, const Layout& layout,
                              const Window& window) {
    FieldWindow out;
    out.window = window;
    out.grid = part_of(layout.grid, window);
    out.vf_rad.resize(at(window.size()));
    out.closed.resize(at(window.size()));
    for (const std::int64_t tile : layout.tiles_in(window)) {
        const Window whole = layout.tile_window(tile);
        const Window part = shared(whole, window);
        const h5::Reader file(field_shard(dir, layout, tile));
        const std::array<std::uint64_t, 2> from = {
            static_cast<std::uint64_t>(part.y_begin - whole.y_begin),
            static_cast<std::uint64_t>(part.x_begin - whole.x_begin)};
        const std::array<std::uint64_t, 2> shape = {
            static_cast<std::uint64_t>(part.y_end - part.y_begin),
            static_cast<std::uint64_t>(part.x_end - part.x_begin)};
        copy_shared(part, file.read_window<float>("vf", from, shape), window, out.vf_rad);
        copy_shared(part, file.read_window<std::uint8_t>("closed", from, shape), window,
                    out.closed);
    }
    return out;
}

}  // namespace vfplan
