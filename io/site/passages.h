// The triangles of a plan and the ways between them: what ground is found by.
#pragma once

#include <algorithm>
#include <vector>

#include "io/site/subdivision.h"
#include "kernels/index.h"

namespace vfplan {

// `wall` and `shut` are by edge of the subdivision, which must outlive this, as must they.
class Passages {
public:
    Passages(const Subdivision& s, const std::vector<bool>& wall, const std::vector<bool>& shut,
             double snap_m)
        : s_(s), wall_(wall), shut_(shut), snap_m_(snap_m), n_(s.triangles.triangles.size()) {}

protected:
    // The neighbour over side i of a triangle when no wall is in between, else -1.
    std::int32_t over(std::int32_t t, std::size_t i) const {
        const Triangle& triangle = s_.triangles.triangles[idx(t)];
        return triangle.wall[i] >= 0 && wall_[idx(triangle.wall[i])] ? -1 : triangle.neighbour[i];
    }
    bool is_shut(std::int32_t t, std::size_t i) const {
        const std::int32_t edge = s_.triangles.triangles[idx(t)].wall[i];
        return edge >= 0 && shut_[idx(edge)];
    }
    double width_m(std::int32_t t, std::size_t i) const {
        const Triangle& triangle = s_.triangles.triangles[idx(t)];
        return snap_m_ * (corner(triangle, (i + 1) % 3) - corner(triangle, (i + 2) % 3)).norm();
    }
    const Vec2d& corner(const Triangle& triangle, std::size_t i) const {
        return s_.triangles.vertices[idx(triangle.vertex[i])];
    }
    double triangle_m2(std::int32_t t) const {
        const Triangle& tr = s_.triangles.triangles[idx(t)];
        return orient(corner(tr, 0), corner(tr, 1), corner(tr, 2)) / 2 * snap_m_ * snap_m_;
    }
    bool taken(std::int32_t t) const { return is_taken(s_.kinds[idx(t)]); }
    // What the drawing says is inside; the outside does not flow in.
    bool named(std::int32_t t) const {
        constexpr Kinds inside = bit(outline_area) | bit(room_area) | bit(doorway_area);
        return (s_.kinds[idx(t)] & inside) != 0;
    }
    // Triangles with nothing beyond one of their sides.
    std::vector<std::int32_t> at_the_rim() const {
        std::vector<std::int32_t> out;
        for (std::int32_t t = 0; idx(t) < n_; ++t) {
            const auto& next = s_.triangles.triangles[idx(t)].neighbour;
            if (std::find(next.begin(), next.end(), -1) != next.end()) out.push_back(t);
        }
        return out;
    }

    const Subdivision& s_;
    const std::vector<bool>& wall_;
    const std::vector<bool>& shut_;
    double snap_m_;
    std::size_t n_;
};

}  // namespace vfplan
