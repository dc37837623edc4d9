// The field, tile by tile: shards/field-SIDE-NUMBER.h5 with the visibility field (`vf`) and the
// links between cells that walls close (`closed`).
#pragma once

#include "engine/work.h"

namespace vfplan {

std::filesystem::path field_shard(const std::filesystem::path& dir, const Layout& layout,
                                  std::int64_t tile);

// Makes all tiles (SPEC section 2).
void make_field_tiles(const Work& work);
// What they cost, whoever made them when.
FieldCounts count_field(const Work& work);

// A window of the field, with what follows from it.
struct FieldWindow {
    Window window;
    Grid grid;                    // of the window alone
    Raster<float> vf_rad;         // NaN where no station can stand
    Raster<std::uint8_t> closed;  // bit k: a wall parts the cell from its neighbour k

    bool inside(std::int32_t ix, std::int32_t iy) const { return window.contains(ix, iy); }
    // Index in the rasters of a cell of the whole grid.
    std::size_t index(std::int32_t ix, std::int32_t iy) const {
        return static_cast<std::size_t>(grid.id(ix - window.x_begin, iy - window.y_begin));
    }
    // Where the skeleton may lie: VF at least the threshold, no closed link.
    bool in_domain(std::size_t i, double threshold_rad) const;
    Raster<std::uint8_t> domain(double threshold_rad) const;
};
FieldWindow read_field_window(const std::filesystem::path& dir, const Layout& layout,
                              const Window& window);

}  // namespace vfplan
