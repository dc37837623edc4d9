// Shortest paths over cells.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/free_cells.h"
#include "kernels/grid.h"
#include "kernels/index.h"

namespace vfplan {

// A flood from many sources over free cells that no wall parts, as far as `most`: distance in steps
// of 10 and 14, so that it is a whole number. Each cell belongs to the nearest source, of equally
// near ones to that with the least name, and was reached over the neighbour with the least number
// that has this source: whatever the order of work. A window of a larger grid gives the same inside
// it, as far from its edge as the flood goes.
class Flood {
public:
    static constexpr std::int32_t unreached = std::numeric_limits<std::int32_t>::max();

    // `closed`: see closed_steps(). Refers to the rasters.
    Flood(const Grid& grid, const Raster<std::uint8_t>& free, const Raster<std::uint8_t>& closed,
          std::int32_t most);

    void add_source(std::int64_t cell, std::int32_t name);
    void run();

    std::int32_t distance(std::int64_t cell) const { return distance_[idx(cell)]; }
    std::int32_t source(std::int64_t cell) const { return source_[idx(cell)]; }
    // From the source to the cell.
    std::vector<std::int64_t> path_to(std::int64_t cell) const;

private:
    static constexpr std::size_t buckets = 15;  // one more than the longest step

    void reach(std::int64_t cell, std::int32_t far, std::int32_t source, std::int8_t over);

    const Grid& grid_;
    const Raster<std::uint8_t>& free_;
    const Raster<std::uint8_t>& closed_;
    std::int32_t most_;
    std::vector<std::int32_t> distance_;
    std::vector<std::int32_t> source_;
    std::vector<std::int8_t> over_;  // the direction that leads back to the source; -1 for sources
    std::vector<std::vector<std::int64_t>> waiting_;  // by distance, modulo their number
    std::size_t left_ = 0;
};

}  // namespace vfplan
