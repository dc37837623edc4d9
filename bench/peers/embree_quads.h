// Peer: the bare Embree packet loop. Walls as upright quads (its own float intersection, ROBUST),
// packets of 4 x 4 cells that share a direction, nothing done with what the rays meet.
#pragma once

#include <memory>
#include <vector>

#include "kernels/grid.h"
#include "kernels/wall.h"

namespace vfplan::peers {

class EmbreeQuads {
public:
    EmbreeQuads(const std::vector<Wall>& walls, const Box& around, double reach_m);
    ~EmbreeQuads();

    // Not thread-safe. Casts `rays` evenly spread rays from up to 16 eyes; returns how many met a
    // wall.
    std::int64_t cast(const std::vector<Vec2d>& eyes, int rays) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vfplan::peers
