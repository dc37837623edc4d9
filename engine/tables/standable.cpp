#include "engine/tables/standable.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "engine/tables/ground_band.h"
#include "io/formats/read_features.h"
#include "io/site/site_reader.h"
#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Patches of a row that are worked on together: all, unless they have many cells.
std::int64_t patches_at_once(const Layout& layout) {
    const std::int64_t patch = std::int64_t{layout.patch_cells} * layout.patch_cells;
    return std::max<std::int64_t>(1, cells_at_once / patch);
}

}  // namespace

std::vector<Border> forbidden_border(const GroundOptions& o, const Site& site) {
    if (o.forbidden.empty()) return {};
    ReadOptions read;
    read.crs = site.crs_wkt;  // to where the site is
    read.unit_m = o.site.unit_m;
    read.allow_network = o.site.allow_network;
    std::vector<Polygon> polygons;
    for (Feature& f : read_features(o.forbidden, read).features) {
        each_point(f, [&](Vec2d& v) { v -= site.origin; });
        for (Polygon& p : f.polygons) polygons.push_back(std::move(p));
    }
    return border_of_union(polygons, o.site.snap_m);
}

std::vector<std::vector<std::uint8_t>> standable_bits(const GroundOptions& o, const Site& site,
                                                      const Layout& layout,
                                                      const Threads& threads) {
    const std::vector<Border> forbidden = forbidden_border(o, site);
    std::vector<std::vector<std::uint8_t>> out(idx(layout.patches()));
    threads.for_each(layout.patch_rows(), 1, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t row = from; row < to; ++row) {
            const std::int64_t first = row * layout.patch_columns();
            Window window = layout.patch_window(first);
            window.x_end = layout.grid.nx;
            const GroundBand band(o, site, forbidden, part_of(layout.grid, window));
            const std::int64_t some = patches_at_once(layout);
            for (std::int64_t p = 0; p < layout.patch_columns(); p += some) {
                const std::int64_t behind =
                    std::min<std::int64_t>(p + some, layout.patch_columns());
                window.x_begin = layout.patch_window(first + p).x_begin;
                window.x_end = layout.patch_window(first + behind - 1).x_end;
                const Grid grid = part_of(layout.grid, window);
                const Raster<std::uint8_t> free = ground_of(o, band, grid).standable;
                for (std::int64_t q = first + p; q < first + behind; ++q) {
                    const Window w = layout.patch_window(q);
                    std::vector<std::uint8_t>& bits = out[idx(q)];
                    bits.assign((idx(w.size()) + 7) / 8, 0);
                    std::size_t i = 0;
                    for (std::int32_t y = 0; y < grid.ny; ++y) {
                        for (std::int32_t x = w.x_begin; x < w.x_end; ++x, ++i) {
                            const bool is_free = free[idx(grid.id(x - window.x_begin, y))] != 0;
                            const unsigned bit = is_free ? 1U << (i % 8) : 0U;
                            bits[i / 8] = static_cast<std::uint8_t>(bits[i / 8] | bit);
                        }
                    }
                }
            }
        }
    });
    return out;
}

FreeCells count_free_cells(const GroundOptions& o, const Site& site, const Grid& grid,
                           const Threads& threads, std::int64_t looked_at_most) {
    constexpr std::int64_t windows_most = 64;
    constexpr std::int32_t rows = 32;
    const std::vector<Border> forbidden = forbidden_border(o, site);
    const auto columns = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(looked_at_most / windows_most / rows, 1, grid.nx));
    const std::int64_t across = (grid.nx + columns - 1) / columns;
    const std::int64_t all = across * ((grid.ny + rows - 1) / rows);
    const bool exact = grid.size() <= looked_at_most;
    std::atomic<std::int64_t> free = 0;
    std::atomic<std::int64_t> looked_at = 0;
    threads.for_each(exact ? all : windows_most, 1, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t i = from; i < to; ++i) {
            // Spread without a rhythm that streets could have.
            constexpr double golden = 0.6180339887498949;
            const double turn = (static_cast<double>(i) + 0.5) * golden;
            const auto some =
                static_cast<std::int64_t>((turn - std::floor(turn)) * static_cast<double>(all));
            const std::int64_t w = exact ? i : some;
            const auto x = static_cast<std::int32_t>(w % across) * columns;
            const auto y = static_cast<std::int32_t>(w / across) * rows;
            const Window window{x, y, std::min(x + columns, grid.nx), std::min(y + rows, grid.ny)};
            const Grid part = part_of(grid, window);
            const Raster<std::uint8_t> cells =
                ground_of(o, GroundBand(o, site, forbidden, part), part).standable;
            free += std::count(cells.begin(), cells.end(), 1);
            looked_at += window.size();
        }
    });
    if (exact) return {free, true};
    const double share = static_cast<double>(free) / static_cast<double>(looked_at);
    return {static_cast<std::int64_t>(share * static_cast<double>(grid.size())), false};
}

}  // namespace vfplan
