// Whether a cell is in sight of a point on a wall.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/tables/scenes.h"
#include "kernels/index.h"

namespace vfplan {

// What an eye sees, in the scene's frame. Refers to the scene.
class Sight {
public:
    Sight(const Scene& scene, const Vec2d& eye);

    bool sees(const Vec2d& p) const;
    // Adds stretches of rows, from and to in x, so that all that is in sight within range of rows
    // at y_m + n * step_m lies in `rows[n]`, and what lies up to a step beside.
    using Stretches = std::vector<std::pair<double, double>>;
    void add_rows(double range_m, double y_m, double step_m, std::vector<Stretches>& rows) const;
    // Everything in sight within range lies in it.
    Box reach(double range_m) const;

private:
    const Wall& wall(const Span& s) const { return scene_.walls()[idx(s.wall)]; }

    const Scene& scene_;
    Vec2d eye_;
    View view_;
    std::vector<double> starts_;
    std::vector<std::size_t> order_;
};

}  // namespace vfplan
