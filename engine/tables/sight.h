// Whether a cell is in sight of a point on a wall.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/tables/scenes.h"
#include "kernels/index.h"

namespace vfplan {

// What an eye sees, in the scene's frame. Refers to the scene.
class Sight {
public:
    Sight(const Scene& scene, const Vec2d& eye);

    bool sees(const Vec2d& p) const;
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
