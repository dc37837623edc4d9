// The skeleton by tile, and the joints and ridges over all tiles.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/tables/shard.h"
#include "kernels/layout.h"
#include "kernels/ridges.h"

namespace vfplan {

// work/.../skeleton-TILE.h5: the skeleton cells of a tile.
void write_skeleton_tile(const std::filesystem::path& path, const std::string& key,
                         const SkeletonCells& cells);

// Thread-safe. Throws IoError.
class SkeletonTiles {
public:
    SkeletonTiles(Layout layout, ShardNames names)
        : layout_(std::move(layout)), names_(std::move(names)) {}

    const Layout& layout() const { return layout_; }
    // Of the whole grid, ascending.
    SkeletonCells all() const;

private:
    Layout layout_;
    ShardNames names_;
};

// work/.../ridges.h5: joints and ridges by the tile of their first cell.
void write_ridges(const std::filesystem::path& path, const std::string& key, const Layout& layout,
                  const RidgeGraph& graph);

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

// Thread-safe. Throws IoError.
class RidgeTiles {
public:
    RidgeTiles(Layout layout, std::filesystem::path file)
        : layout_(std::move(layout)), file_(std::move(file)) {}

    const Layout& layout() const { return layout_; }
    TileRidges tile(std::int64_t tile) const;
    std::int64_t joints() const;  // how many there are
    std::int64_t ridges() const;

private:
    Layout layout_;
    std::filesystem::path file_;
};

}  // namespace vfplan
