// The exact kernel: triangular expansion (Bungiu et al.) over a constrained triangulation, in
// double precision. Every end of every span is a wall's end or the shadow of one.
#pragma once

#include <memory>
#include <vector>

#include "kernels/triangulation.h"
#include "kernels/view.h"

namespace vfplan {

class ExactScene final : public ViewKernel {
public:
    // `around`: where eyes may stand. Walls farther than reach_m from an eye are not looked for.
    // Throws InputError when walls cross (see triangulate()).
    ExactScene(const std::vector<Wall>& walls, const Box& around, double reach_m);

    void first_hits(const Vec2d& eye, View& out) const override;

private:
    std::int32_t locate(const Vec2d& eye) const;
    bool walk(std::int32_t from, const Vec2d& eye, std::int32_t& found) const;
    void emit(const Vec2d& eye, std::int32_t wall, std::int32_t right_vertex,
              std::int32_t left_vertex, View& out) const;

    std::vector<Wall> walls_;
    Triangulation mesh_;
    double reach_m_ = 0;
    // A triangle to start the walk from, for each square of a coarse grid.
    Vec2d seeds_origin_{0, 0};
    double seeds_cell_m_ = 1;
    std::int32_t seeds_nx_ = 0;
    std::vector<std::int32_t> seeds_;
};

}  // namespace vfplan
