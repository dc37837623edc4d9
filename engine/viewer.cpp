#include "engine/viewer.h"

#include <limits>

#include "kernels/embree_scene.h"
#include "kernels/exact_scene.h"

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

Raster<float> visibility_field(const Viewer& viewer, const Threads& threads, const Grid& grid,
                               const Raster<std::uint8_t>& standable,
                               const std::function<void(std::int64_t)>& progress) {
    Raster<float> vf(standable.size(), std::numeric_limits<float>::quiet_NaN());
    threads.for_each(grid.size(), 512, [&](std::int64_t from, std::int64_t to) {
        View hits;
        View seen;
        for (std::int64_t cell = from; cell < to; ++cell) {
            const auto i = static_cast<std::size_t>(cell);
            if (standable[i] == 0) continue;
            const Vec2d eye = grid.centre(cell);
            viewer.kernel().first_hits(eye, hits);
            observe(viewer.walls(), viewer.scanner(), eye, hits, seen);
            vf[i] = static_cast<float>(view_angle_rad(seen));
        }
        progress(to - from);
    });
    return vf;
}

}  // namespace vfplan
