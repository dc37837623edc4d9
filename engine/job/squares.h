// A site in squares, some of which are tried.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/wall.h"

namespace vfplan {

// The squares of a site, with the length of the faces to scan of walls whose middles lie in each.
class Squares {
public:
    Squares(const Site& site, double side_m);

    struct Taken {
        std::size_t square = 0;
        double times = 1;  // how often it was hit
    };
    // Systematic sampling: each square as often as its share of walls, `n` hits in all.
    std::vector<Taken> by_walls(int n) const;
    // Up to `n` of those without walls, spread evenly.
    std::vector<Taken> without_walls(int n) const;

    Box box(std::size_t square) const;  // as far as the site goes
    double walls_m(std::size_t square) const { return walls_m_[square]; }
    double all_walls_m() const { return all_walls_m_; }
    // Of the site's area, in squares with walls.
    double share_with_walls() const;

private:
    Box extent_;
    double side_m_ = 0;
    std::int64_t columns_ = 0;
    std::vector<double> walls_m_;
    double all_walls_m_ = 0;
};

// The part of a site in a box, with the walls that are nearer to it than `reach_m`; that is lowered
// until these are no more than `walls_most`.
Site part_of_site(const Site& site, const Box& box, double reach_m, std::size_t walls_most);

}  // namespace vfplan
