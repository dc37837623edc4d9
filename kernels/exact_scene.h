// The exact kernel: triangular expansion (Bungiu et al.) over a constrained triangulation, in
// double precision. Every end of every span is a wall's end or the shadow of one.
#pragma once

#include <vector>

#include "kernels/expansion.h"
#include "kernels/locator.h"
#include "kernels/view.h"

namespace vfplan {

class ExactScene final : public ViewKernel {
public:
    // `around`: where eyes may stand. Walls farther than reach_m from an eye are not looked for.
    // Throws InputError when walls cross (see triangulate()).
    ExactScene(const std::vector<Wall>& walls, const Box& around, double reach_m);
    ExactScene(const ExactScene&) = delete;
    ExactScene& operator=(const ExactScene&) = delete;

    void first_hits(const Vec2d& eye, View& out) const override;
    FieldCounts field(const Scanner& scanner, const Grid& grid, const Window& window,
                      const Raster<std::uint8_t>& standable, Raster<float>& vf_rad) const override;

    // vf_rad[i] = VF(eyes[i]) in double precision. Fast where eyes are near each other in space and
    // in order. An eye in no triangle sees nothing.
    FieldCounts angles(const Scanner& scanner, const std::vector<Vec2d>& eyes,
                       std::vector<double>& vf_rad) const;

private:
    std::vector<Wall> walls_;
    Expansion expansion_;
    TriangleLocator locator_;
    double reach_m_ = 0;
};

}  // namespace vfplan
