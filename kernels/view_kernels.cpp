#include "kernels/view_kernels.h"

#include "kernels/embree_scene.h"
#include "kernels/exact_scene.h"

namespace vfplan {

std::unique_ptr<ViewKernel> make_kernel(KernelKind kind, const std::vector<Wall>& walls,
                                        const Box& around, double reach_m, int rays) {
    if (kind == KernelKind::exact) return std::make_unique<ExactScene>(walls, around, reach_m);
    return std::make_unique<EmbreeScene>(walls, around, reach_m, rays);
}

}  // namespace vfplan
