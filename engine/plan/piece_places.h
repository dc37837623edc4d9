// Where pieces lie, worked out of the walls: nothing is kept for each piece.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "kernels/coverage.h"
#include "kernels/index.h"
#include "kernels/wall.h"

namespace vfplan {

// As cut_into_pieces() cuts: the sides of walls one after another, each into equal parts. Refers to
// the walls.
class PiecePlaces {
public:
    struct Place {
        Vec2d middle{0, 0};
        Vec2d along{0, 0};  // unit vector of the wall
    };

    PiecePlaces(const std::vector<Wall>& walls, const Pieces& pieces) : walls_(walls) {
        for (std::int32_t wall = 0; wall < pieces.walls(); ++wall) {
            for (const Side side : {left, right}) {
                if (pieces.count(wall, side) == 0) continue;
                first_.push_back(pieces.first(wall, side));
                wall_.push_back(wall);
            }
        }
        first_.push_back(static_cast<std::int32_t>(pieces.size()));
    }

    // Calls f(piece, place) for pieces that ascend.
    template <class Numbers, class F>
    void each(const Numbers& pieces, F&& f) const {
        std::size_t face = 0;
        std::int32_t end = 0;  // of the side at hand
        double length = 0;
        Vec2d along(0, 0);
        for (const std::int32_t p : pieces) {
            if (p >= end) {
                face = static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), p) -
                                                first_.begin()) -
                       1;
                end = first_[face + 1];
                const Wall& wall = walls_[idx(wall_[face])];
                length = wall.length_m();
                along = (wall.b - wall.a).normalized();
            }
            const std::int32_t n = end - first_[face];
            const std::int32_t k = p - first_[face];
            const double middle = (length * k / n + length * (k + 1) / n) / 2;
            f(p, Place{walls_[idx(wall_[face])].at(middle), along});
        }
    }

private:
    const std::vector<Wall>& walls_;
    std::vector<std::int32_t> first_;  // of each side with pieces; at last the number of pieces
    std::vector<std::int32_t> wall_;   // of each such side
};

}  // namespace vfplan
