#include "engine/tables/narrow.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "engine/tables/ground_band.h"
#include "kernels/disjoint_sets.h"
#include "kernels/distance.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Narrow cells of a row next to each other.
struct Run {
    std::int32_t y = 0;
    std::int32_t begin = 0;
    std::int32_t end = 0;
};

// Rows from..to of the layout's grid, in order.
std::vector<Run> runs_of_rows(const GroundOptions& o, const Site& site, const Grid& whole,
                              std::int32_t from, std::int32_t to) {
    // Cells are that coarse.
    const double far_cells = (o.clearance_m + o.cell_m) / o.cell_m;
    const double far_squared = far_cells * far_cells;
    // Beyond the grid of distances counts as near: it is farther off than anything asked for.
    const auto halo = static_cast<std::int32_t>(far_cells) + 2;
    const Grid grid = part_of(whole, {-halo, from - halo, whole.nx + halo, to + halo});
    const Ground ground = ground_of(o, GroundBand(o, site, {}, grid), grid);
    Raster<std::uint8_t> off(ground.standable.size());
    for (std::size_t i = 0; i < off.size(); ++i) off[i] = ground.standable[i] == 0 ? 1 : 0;
    DistanceField distance;
    distance.resize(grid.size());
    distance_columns(grid, off, 0, grid.nx, distance);
    distance_rows(grid, off, 0, grid.ny, distance);
    std::vector<Run> out;
    for (std::int32_t y = from; y < to; ++y) {
        bool within = false;
        for (std::int32_t x = 0; x < whole.nx; ++x) {
            const std::size_t cell = idx(grid.id(x + halo, y - from + halo));
            const std::int32_t squared = distance.squared[cell];
            const bool narrow = ground.free[cell] != 0 && squared > far_squared;
            if (narrow && !within) out.push_back({y, x, x});
            within = narrow;
            if (narrow) out.back().end = x + 1;
        }
    }
    return out;
}

// Joins runs of neighbouring rows that have an edge in common. `runs`: row by row.
DisjointSets joined(const std::vector<Run>& runs) {
    DisjointSets sets(static_cast<std::int64_t>(runs.size()));
    std::size_t below = 0;
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::int32_t y = runs[i].y - 1;
        const auto is_before = [&](const Run& r) {
            return r.y < y || (r.y == y && r.end <= runs[i].begin);
        };
        while (is_before(runs[below])) ++below;
        for (std::size_t k = below; runs[k].y == y && runs[k].begin < runs[i].end; ++k) {
            sets.merge(static_cast<std::int32_t>(i), static_cast<std::int32_t>(k));
        }
    }
    return sets;
}

}  // namespace

std::vector<NarrowPlace> narrow_places(const GroundOptions& o, const Site& site,
                                       const Layout& layout, const Threads& threads) {
    if (o.clearance_m <= 0) return {};
    constexpr std::int32_t rows = 128;
    const Grid& grid = layout.grid;
    const std::int64_t bands = (grid.ny + rows - 1) / rows;
    std::vector<std::vector<Run>> of_band(idx(bands));
    threads.for_each(bands, 1, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t b = from; b < to; ++b) {
            const auto first = static_cast<std::int32_t>(b * rows);
            of_band[idx(b)] = runs_of_rows(o, site, grid, first, std::min(first + rows, grid.ny));
        }
    });
    std::vector<Run> runs;
    for (const auto& some : of_band) runs.insert(runs.end(), some.begin(), some.end());
    DisjointSets sets = joined(runs);
    std::vector<NarrowPlace> places(runs.size());
    std::vector<Vec2d> middle(runs.size(), Vec2d(0, 0));  // sums, weighted by area
    const double cell_m2 = o.cell_m * o.cell_m;
    const auto centre = [&](const Run& run) -> Vec2d {
        return (grid.centre(grid.id(run.begin, run.y)) + grid.centre(grid.id(run.end - 1, run.y))) /
               2;
    };
    const auto set_of = [&](std::size_t run) {
        return idx(sets.root(static_cast<std::int32_t>(run)));
    };
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const double area_m2 = (runs[i].end - runs[i].begin) * cell_m2;
        places[set_of(i)].area_m2 += area_m2;
        middle[set_of(i)] += area_m2 * centre(runs[i]);
    }
    std::vector<double> off(runs.size(), std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < runs.size(); ++i) {
        const std::size_t set = set_of(i);
        const double off_m = (centre(runs[i]) - middle[set] / places[set].area_m2).norm();
        if (off_m >= off[set]) continue;
        off[set] = off_m;
        places[set].at = centre(runs[i]);
    }
    places.erase(std::remove_if(places.begin(), places.end(),
                                [&](const NarrowPlace& p) {
                                    return p.area_m2 == 0 || p.area_m2 < o.site.min_room_m2;
                                }),
                 places.end());
    std::sort(places.begin(), places.end(), [](const NarrowPlace& a, const NarrowPlace& b) {
        return std::make_tuple(-a.area_m2, a.at.x(), a.at.y()) <
               std::make_tuple(-b.area_m2, b.at.x(), b.at.y());
    });
    return places;
}

double area_m2(const std::vector<NarrowPlace>& places) {
    double sum = 0;
    for (const NarrowPlace& p : places) sum += p.area_m2;
    return sum;
}

std::string narrow_text(const std::vector<NarrowPlace>& places, const GroundOptions& o,
                        const Site& site) {
    constexpr std::size_t most = 10;
    std::string out = fmt::format(
        "narrow       {:.2f} m2 of ground in {} {} where no station may stand {} m from walls "
        "(site.clearance_m)",
        area_m2(places), places.size(), places.size() == 1 ? "place" : "places", o.clearance_m);
    for (std::size_t i = 0; i < std::min(most, places.size()); ++i) {
        const Vec2d at = places[i].at + site.origin;
        out +=
            fmt::format("\n  {:>9.2f} m2 at ({:.2f}, {:.2f})", places[i].area_m2, at.x(), at.y());
    }
    return out + (places.size() > most ? "\n  ..." : "");
}

}  // namespace vfplan
