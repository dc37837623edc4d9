// The skeleton, tile by tile, and the ridge graph over all of them.
#pragma once

#include "engine/work.h"
#include "kernels/ridges.h"

namespace vfplan {

// work/skeleton-NUMBER.h5: the skeleton cells of each tile (SPEC section 3). The same cells as if
// the whole grid had been thinned at once: a tile is thinned with so much around it that the fate
// of each of its cells is certain.
void make_skeleton_tiles(const Work& work);

// work/graph-00000.h5: joints and ridges by the tile of their first cell. Throws UsageError when
// there are none and `needed`.
void make_ridge_graph(const Work& work, bool needed);

// The joints and ridges that belong to a tile.
struct TileRidges {
    std::vector<std::int64_t> joints;
    struct Line {
        std::vector<std::int64_t> cells;
        std::int64_t joint[2] = {-1, -1};  // their cells, -1 for none
        bool ring = false;
    };
    std::vector<Line> ridges;
};
TileRidges read_tile_ridges(const Work& work, std::int64_t tile);

struct RidgeCounts {
    std::int64_t joints = 0;
    std::int64_t ridges = 0;
};
RidgeCounts count_ridges(const Work& work);

}  // namespace vfplan
