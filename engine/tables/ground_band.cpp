#include "engine/tables/ground_band.h"

#include <algorithm>
#include <cmath>

#include "kernels/free_cells.h"
#include "kernels/index.h"
#include "kernels/passages.h"

namespace vfplan {
namespace {

// Pieces of a border that a band of rows may cross.
std::vector<Border> pieces_in(const std::vector<Border>& border, double y_min, double y_max) {
    std::vector<Border> out;
    for (const Border& piece : border) {
        if (std::min(piece.a.y(), piece.b.y()) > y_max) continue;
        if (std::max(piece.a.y(), piece.b.y()) < y_min) continue;
        out.push_back(piece);
    }
    return out;
}

// How many cells beyond a window one has to look at to decide about it: whether a narrow place is a
// passage is for its surroundings to say.
std::int32_t halo_cells(const GroundOptions& o) {
    if (o.clearance_m <= 0) return 0;
    return static_cast<std::int32_t>(std::ceil(passage_reach_m(o.clearance_m) / o.cell_m)) + 1;
}

Raster<std::uint8_t> inner_part(const Raster<std::uint8_t>& cells, const Grid& grid,
                                std::int32_t halo) {
    Raster<std::uint8_t> out;
    out.reserve(cells.size());
    for (std::int32_t y = halo; y < grid.ny - halo; ++y) {
        const auto row = cells.begin() + grid.id(0, y);
        out.insert(out.end(), row + halo, row + grid.nx - halo);
    }
    return out;
}

}  // namespace

GroundBand::GroundBand(const GroundOptions& o, const Site& site,
                       const std::vector<Border>& kept_out_all, const Grid& rows) {
    const double halo_m = halo_cells(o) * o.cell_m;
    const double y_min = rows.origin.y() - halo_m;
    const double y_max = rows.origin.y() + rows.cell_m * rows.ny + halo_m;
    free = pieces_in(site.free_border, y_min, y_max);
    kept_out = pieces_in(kept_out_all, y_min, y_max);
    const double reach = std::max(o.clearance_m, o.cell_m);
    for (const Wall& w : site.walls) {
        if (std::max(w.a.y(), w.b.y()) + reach < y_min) continue;
        if (std::min(w.a.y(), w.b.y()) - reach > y_max) continue;
        walls.push_back(w);
    }
}

Ground ground_of(const GroundOptions& o, const GroundBand& band, const Grid& grid) {
    const std::int32_t halo = halo_cells(o);
    const Grid around = part_of(grid, {-halo, -halo, grid.nx + halo, grid.ny + halo});
    Ground out{free_cells(around, band.free), {}};
    Raster<std::uint8_t> near = cells_on_walls(around, band.walls);
    for (std::size_t i = 0; i < near.size(); ++i) {
        if (near[i] != 0) out.free[i] = 0;
    }
    out.standable = out.free;
    if (o.clearance_m > 0) {
        near = cells_near_walls(around, band.walls, o.clearance_m);
        const Raster<std::uint8_t> passage =
            cells_in_passages(around, out.free, near, band.walls, o.clearance_m);
        for (std::size_t i = 0; i < near.size(); ++i) {
            if (near[i] != 0 && passage[i] == 0) out.standable[i] = 0;
        }
    }
    const Raster<std::uint8_t> kept_out = free_cells(around, band.kept_out);
    for (std::size_t i = 0; i < kept_out.size(); ++i) {
        if (kept_out[i] != 0) out.standable[i] = 0;
    }
    if (halo > 0) {
        for (Raster<std::uint8_t>* cells : {&out.free, &out.standable}) {
            *cells = inner_part(*cells, around, halo);
        }
    }
    return out;
}

}  // namespace vfplan
