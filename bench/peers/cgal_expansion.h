// Peer: CGAL's Triangular_expansion_visibility_2, with exact numbers, as its manual recommends.
#pragma once

#include <memory>
#include <vector>

#include "kernels/scanner.h"
#include "kernels/wall.h"

namespace vfplan::peers {

// It knows no range: it always computes all that can be seen.
class CgalExpansion {
public:
    // `around`: where eyes may stand.
    CgalExpansion(const std::vector<Wall>& walls, const Box& around);
    ~CgalExpansion();

    // The query: corners of the visible region, read out, counter-clockwise. The eye's face is
    // found once and for all, as if all eyes stood outdoors: see stand_at().
    void see(const Vec2d& eye, std::vector<Vec2d>& corners) const;

    // Finds the face of this and the following eyes. Throws std::invalid_argument on a wall.
    void stand_at(const Vec2d& eye);

    // VF (eq. 5) from the region's edges; all walls count as scanned.
    double vf_rad(const Vec2d& eye, const Scanner& scanner) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace vfplan::peers
