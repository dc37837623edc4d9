// Which pieces may be seen from one place together with those of another set: by distance alone.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/layout.h"

namespace vfplan {

// What is seen of a place: pieces of no set, of one (its number), of several.
inline constexpr std::int32_t sees_nothing = -1;
inline constexpr std::int32_t sees_several = -2;
constexpr std::int32_t seen_together(std::int32_t a, std::int32_t b) {
    if (a == sees_nothing || a == b) return b;
    return b == sees_nothing ? a : sees_several;
}

// Pieces are noted in squares of cells, an eighth of the reach wide; places are squares, too, so
// what is said of them is never too little. Not thread-safe while it is made.
class Meetings {
public:
    // Of pieces in a window of cells, seen from places that are no more than `reach_cells` away.
    Meetings(const Window& window, std::int32_t reach_cells);

    // A piece with its middle in the cell, of a set; or one that is to be looked at in any case:
    // sees_several.
    void add(std::int32_t x, std::int32_t y, std::int32_t set);
    // After all are added.
    void find();
    // False only where no place within reach of the cell has pieces of another set than one within
    // reach, and none that is to be looked at.
    bool near_several(std::int32_t x, std::int32_t y) const {
        return meets_[square(x, y)] == sees_several;
    }

private:
    std::size_t square(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>((y - window_.y_begin) / side_) *
                   static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>((x - window_.x_begin) / side_);
    }
    // Of each square what those within reach hold.
    std::vector<std::int32_t> spread(const std::vector<std::int32_t>& squares) const;

    Window window_;
    std::int32_t reach_cells_;
    std::int32_t side_;
    std::int32_t columns_;
    std::int32_t rows_;
    std::vector<std::int32_t> meets_;
};

}  // namespace vfplan
