// The field, tile by tile: shards/field-SIDE-NUMBER.h5 with the visibility field (`vf`) and the
// links between cells that walls close (`closed`).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/tables/shard.h"
#include "kernels/layout.h"
#include "kernels/view.h"

namespace vfplan {

struct FieldTile {
    Window window;
    Raster<float> vf_rad;         // NaN where no station can stand
    Raster<std::uint8_t> closed;  // bit k: a wall parts the cell from its neighbour k
    FieldCounts counts;           // what it cost
};
void write_field_tile(const std::filesystem::path& path, const std::string& key,
                      const FieldTile& tile);

// A window of the field, with what follows from it.
struct FieldWindow {
    Window window;
    Grid grid;  // of the window alone
    Raster<float> vf_rad;
    Raster<std::uint8_t> closed;

    bool inside(std::int32_t ix, std::int32_t iy) const { return window.contains(ix, iy); }
    // Index in the rasters of a cell of the whole grid.
    std::size_t index(std::int32_t ix, std::int32_t iy) const {
        return static_cast<std::size_t>(grid.id(ix - window.x_begin, iy - window.y_begin));
    }
    // Where the skeleton may lie: VF at least the threshold, no closed step.
    bool in_domain(std::size_t i, double threshold_rad) const;
    Raster<std::uint8_t> domain(double threshold_rad) const;
};

// All tiles of a field. Thread-safe. Throws IoError.
class FieldTiles {
public:
    FieldTiles(Layout layout, ShardNames names)
        : layout_(std::move(layout)), names_(std::move(names)) {}

    const Layout& layout() const { return layout_; }
    FieldWindow window(const Window& window) const;
    // What they cost, whoever made them when.
    FieldCounts counts() const;
    std::vector<std::filesystem::path> shards() const;

private:
    Layout layout_;
    ShardNames names_;
};

// Copies the cells that two windows share from one raster to the other.
template <class T>
void copy_shared(const Window& from_window, const Raster<T>& from, const Window& to_window,
                 Raster<T>& to) {
    const Window both = shared(from_window, to_window);
    for (std::int32_t y = both.y_begin; y < both.y_end; ++y) {
        const auto index = [&](const Window& w, std::int32_t x) {
            return static_cast<std::ptrdiff_t>(y - w.y_begin) * (w.x_end - w.x_begin) +
                   (x - w.x_begin);
        };
        std::copy(from.begin() + index(from_window, both.x_begin),
                  from.begin() + index(from_window, both.x_end),
                  to.begin() + index(to_window, both.x_begin));
    }
}

}  // namespace vfplan
