#include "engine/viewer.h"

#include <algorithm>
#include <limits>

#include "kernels/embree_scene.h"
#include "kernels/exact_scene.h"
#include "kernels/index.h"

namespace vfplan {

std::unique_ptr<ViewKernel> make_kernel(const std::string& name, const std::vector<Wall>& walls,
                                        const Box& around, double reach_m, int rays) {
    if (name == "exact") return std::make_unique<ExactScene>(walls, around, reach_m);
    return std::make_unique<EmbreeScene>(walls, around, reach_m, rays);
}

std::vector<CoverageRow> Viewer::rows(const Threads& threads,
                                      const std::vector<Vec2d>& eyes) const {
    std::vector<CoverageRow> out(eyes.size());
    threads.for_each(static_cast<std::int64_t>(eyes.size()), 4,
                     [&](std::int64_t from, std::int64_t to) {
                         for (std::int64_t i = from; i < to; ++i) {
                             const auto k = static_cast<std::size_t>(i);
                             out[k] = row(eyes[k]);
                         }
                     });
    return out;
}

FieldResult visibility_field(const Viewer& viewer, const Threads& threads, const Grid& grid,
                             const Raster<std::uint8_t>& standable,
                             const std::function<void(std::int64_t)>& progress) {
    FieldResult out;
    out.vf_rad.assign(standable.size(), std::numeric_limits<float>::quiet_NaN());
    const std::int32_t columns = (grid.nx + window_cells - 1) / window_cells;
    const std::int32_t rows = (grid.ny + window_cells - 1) / window_cells;
    std::vector<FieldCounts> counts(at(columns) * at(rows));
    threads.for_each(std::int64_t{columns} * rows, 1, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t w = from; w < to; ++w) {
            const auto x = static_cast<std::int32_t>(w % columns) * window_cells;
            const auto y = static_cast<std::int32_t>(w / columns) * window_cells;
            const Window window{x, y, std::min(x + window_cells, grid.nx),
                                std::min(y + window_cells, grid.ny)};
            counts[at(w)] =
                viewer.kernel().field(viewer.scanner(), grid, window, standable, out.vf_rad);
            progress(std::int64_t{window.x_end - window.x_begin} * (window.y_end - window.y_begin));
        }
    });
    for (const FieldCounts& c : counts) out.counts += c;
    return out;
}

}  // namespace vfplan
