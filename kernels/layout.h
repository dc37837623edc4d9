// How a site is cut up, so that no part of the work needs all of it.
//
// Patches are squares of cells, each with a scene of its own in its own frame: the walls in and
// around it. Their size follows from the scanner's range and the cells, never from memory or
// machine, and whatever is seen from a point is seen in the scene of the patch that it lies in. So
// results do not depend on tiles, which are only the portions in which work is done and stored.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/grid.h"
#include "kernels/wall.h"

namespace vfplan {

struct Layout {
    Grid grid;
    std::int32_t patch_cells = 0;  // side of a patch, a multiple of 32
    std::int32_t tile_cells = 0;   // side of a tile, a multiple of 4

    std::int32_t patch_columns() const { return (grid.nx + patch_cells - 1) / patch_cells; }
    std::int32_t patch_rows() const { return (grid.ny + patch_cells - 1) / patch_cells; }
    std::int64_t patches() const { return std::int64_t{patch_columns()} * patch_rows(); }
    std::int32_t tile_columns() const { return (grid.nx + tile_cells - 1) / tile_cells; }
    std::int32_t tile_rows() const { return (grid.ny + tile_cells - 1) / tile_cells; }
    std::int64_t tiles() const { return std::int64_t{tile_columns()} * tile_rows(); }

    Window patch_window(std::int64_t patch) const;
    Window tile_window(std::int64_t tile) const;
    std::int64_t patch_at(std::int32_t ix, std::int32_t iy) const {
        return std::int64_t{iy / patch_cells} * patch_columns() + ix / patch_cells;
    }
    std::int64_t patch_of(std::int64_t cell) const {
        return patch_at(grid.ix(cell), grid.iy(cell));
    }
    std::int64_t tile_of(std::int64_t cell) const {
        return std::int64_t{grid.iy(cell) / tile_cells} * tile_columns() +
               grid.ix(cell) / tile_cells;
    }
    // The cell that a point lies in; the nearest one for points beyond the grid.
    std::int64_t cell_at(const Vec2d& point) const;
    // South-west corner of a patch: the origin of its frame.
    Vec2d patch_origin(std::int64_t patch) const;
    // Cells of the largest window of a tile with so many around it, and of the largest patch.
    double largest_window_cells(double margin) const;
    double largest_patch_cells() const;
    // Patches and tiles that a window touches, ascending.
    std::vector<std::int64_t> patches_in(const Window& window) const;
    std::vector<std::int64_t> tiles_in(const Window& window) const;
};

// A patch is six ranges wide: the walls around it are then at most as many again as those in it.
Layout make_layout(const Grid& grid, double range_max_m, std::int64_t tile_cells);

// The same in tiles of so many cells at least, for work that has to look far around each: where
// cells are small, nearly all of it would be done around tiles.
Layout in_blocks(Layout layout, std::int32_t least_cells);

// How far beyond its patch an eye may stand and still be looked from in its scene: rescue looks
// from points before the pieces of the patch's walls.
double eye_margin_m(double partition_m);

// How far from a patch a wall may be and still be seen from an eye that is looked from in its
// scene.
double wall_reach_m(double range_max_m, double partition_m, double snap_m);

// For each patch the walls whose boxes come within `reach_m` of it, ascending, as compressed rows.
struct NearWalls {
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int32_t> wall;
};
NearWalls near_walls(const Layout& layout, const std::vector<Wall>& walls, double reach_m);

}  // namespace vfplan
