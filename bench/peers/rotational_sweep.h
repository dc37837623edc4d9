// Peer: the classical rotational sweep. All wall ends are sorted by angle around the eye; a
// balanced tree holds the walls that the sweeping ray meets, nearest first. O(n log n) per eye.
#pragma once

#include <vector>

#include "kernels/view.h"

namespace vfplan::peers {

class RotationalSweep {
public:
    // Refers to the walls, which meet at ends only.
    explicit RotationalSweep(const std::vector<Wall>& walls) : walls_(walls) {}

    // VF (eq. 5). Thread-safe.
    double vf_rad(const Vec2d& eye, const Scanner& scanner) const;

private:
    const std::vector<Wall>& walls_;
};

}  // namespace vfplan::peers
