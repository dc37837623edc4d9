// Peer: CGAL's Triangular_expansion_visibility_2, with exact numbers, as its manual recommends.
#pragma once

#include <memory>
#include <vector>

#include "kernels/wall.h"

namespace vfplan::peers {

// Sees without limit of range.
class CgalExpansion {
public:
    // `around`: where eyes may stand.
    CgalExpansion(const std::vector<Wall>& walls, const Box& around);
    ~CgalExpansion();

    // The angle through which `eye` sees walls. Throws std::invalid_argument for an eye on a wall.
    double vf_rad(const Vec2d& eye) const;

    // The query alone: visible region, coordinates read out. Returns its number of corners.
    std::size_t corners(const Vec2d& eye) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vfplan::peers
