#include "io/tables/field_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "io/tables/crs.h"
#include "io/tables/field_tiles.h"
#include "io/tables/shard_index.h"
#include "io/tables/sound.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

std::uint64_t u(std::int64_t i) { return static_cast<std::uint64_t>(i); }

h5::Dims shape_of(const Window& w) { return {u(w.y_end - w.y_begin), u(w.x_end - w.x_begin)}; }

// The field as its tiles make it up.
std::vector<h5::Source> sources_of(const Layout& layout,
                                   const std::vector<std::filesystem::path>& tiles) {
    std::vector<h5::Source> out;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        const Window w = layout.tile_window(static_cast<std::int64_t>(t));
        out.push_back({name_in_index(tiles[t]), "vf", {u(w.y_begin), u(w.x_begin)}, shape_of(w)});
    }
    return out;
}

Layout layout_in(const h5::Reader& file) {
    constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
    const h5::Dims dims = file.dims("vf");
    if (dims.size() != 2 || dims[0] < 1 || dims[1] < 1 || dims[0] > u(most) || dims[1] > u(most)) {
        file.fail("vf is no grid");
    }
    Layout out;
    out.grid.ny = static_cast<std::int32_t>(dims[0]);
    out.grid.nx = static_cast<std::int32_t>(dims[1]);
    out.grid.cell_m = file.number("vf", "cell_m");
    out.grid.origin = {file.number("vf", "grid_origin_x_m"), file.number("vf", "grid_origin_y_m")};
    const auto side = [&](const char* name) {
        return static_cast<std::int32_t>(
            file.whole("vf", name, 1, most - std::max(out.grid.nx, out.grid.ny) + 1));
    };
    out.patch_cells = side("patch_cells");
    out.tile_cells = side("tile_cells");
    sound::finite<double>(file, "the grid's place", {out.grid.origin.x(), out.grid.origin.y()});
    sound::need(file, out.grid.cell_m > 0 && out.grid.cell_m <= sound::farthest_m, "cell_m",
                "is no side of a cell");
    return out;
}

}  // namespace

void write_field_index(const std::filesystem::path& path, const FieldInfo& info,
                       const std::vector<std::filesystem::path>& tiles) {
    h5::Writer file = begin_table(path, "visibility field", info.key);
    file.attribute("/", "Conventions", "CF-1.8");
    file.attribute("/", "summary", info.summary);
    write_crs(file, info.crs_wkt, info.origin);
    const Grid& g = info.layout.grid;
    std::vector<double> x(idx(g.nx));
    std::vector<double> y(idx(g.ny));
    for (std::int32_t i = 0; i < g.nx; ++i) x[idx(i)] = info.origin.x() + g.centre(g.id(i, 0)).x();
    for (std::int32_t i = 0; i < g.ny; ++i) y[idx(i)] = info.origin.y() + g.centre(g.id(0, i)).y();
    file.write("x", x);
    file.write("y", y);
    for (const char* axis : {"x", "y"}) {
        file.attribute(axis, "units", "m");
        file.attribute(axis, "standard_name", std::string("projection_") + axis + "_coordinate");
    }
    file.write_virtual<float>("vf", {u(g.ny), u(g.nx)}, sources_of(info.layout, tiles),
                              std::numeric_limits<float>::quiet_NaN());
    file.attribute("vf", "long_name", "observed angle");
    file.attribute("vf", "units", "radian");
    file.attribute("vf", "grid_mapping", "crs");
    file.attribute("vf", "_FillValue", std::numeric_limits<float>::quiet_NaN());
    file.scale("vf", 0, "y");
    file.scale("vf", 1, "x");
    file.attribute("vf", "cell_m", g.cell_m);
    file.attribute("vf", "grid_origin_x_m", g.origin.x());
    file.attribute("vf", "grid_origin_y_m", g.origin.y());
    file.attribute("vf", "patch_cells", std::int64_t{info.layout.patch_cells});
    file.attribute("vf", "tile_cells", std::int64_t{info.layout.tile_cells});
    write_shard_list(file, tiles);
    finish_table(file);
}

FieldFile::FieldFile(const std::filesystem::path& path) {
    const h5::Reader file(path);
    check_version(file, path);
    info_.key = file.text("/", "key");
    info_.summary = file.text("/", "summary");
    info_.crs_wkt = read_crs(file, info_.origin);
    info_.layout = layout_in(file);
    tiles_ = check_shards(path);
    if (static_cast<std::int64_t>(tiles_.size()) != info_.layout.tiles()) {
        file.fail(fmt::format("it has {} tiles, not {}", tiles_.size(), info_.layout.tiles()));
    }
    check_sources(file, "vf", sources_of(info_.layout, tiles_));
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        const h5::Reader tile(tiles_[t]);
        const Window w = info_.layout.tile_window(static_cast<std::int64_t>(t));
        if (tile.dims("vf") != shape_of(w)) tile.fail("vf has another size than its tile");
    }
}

Raster<float> FieldFile::read(const Window& w) const {
    Raster<float> out(idx(w.size()));
    for (const std::int64_t tile : info_.layout.tiles_in(w)) {
        const Window whole = info_.layout.tile_window(tile);
        const Window part = shared(whole, w);
        copy_shared(
            part,
            h5::Reader(tiles_[idx(tile)])
                .read_window<float>(
                    "vf", {u(part.y_begin - whole.y_begin), u(part.x_begin - whole.x_begin)},
                    {u(part.y_end - part.y_begin), u(part.x_end - part.x_begin)}),
            w, out);
    }
    return out;
}

void FieldFile::each_band(const std::function<void(const Window&, const Raster<float>&)>& f) const {
    constexpr std::int32_t rows = 512;  // as the chunks of tiles
    const Grid& g = grid();
    for (std::int32_t y = 0; y < g.ny; y += rows) {
        const Window band{0, y, g.nx, std::min(y + rows, g.ny)};
        f(band, read(band));
    }
}

FieldFile::Reduced FieldFile::reduced(std::int64_t most) const {
    const Grid& g = grid();
    std::int32_t side = 1;
    while (g.size() / (std::int64_t{side} * side) > most) side *= 2;
    Reduced out;
    out.grid = {g.origin, g.cell_m * side, (g.nx + side - 1) / side, (g.ny + side - 1) / side};
    out.vf_rad.assign(idx(out.grid.size()), 0);
    std::vector<std::int32_t> count(out.vf_rad.size(), 0);
    each_band([&](const Window& w, const Raster<float>& vf) {
        for (std::size_t i = 0; i < vf.size(); ++i) {
            if (std::isnan(vf[i])) continue;
            const auto k = static_cast<std::int64_t>(i);
            const auto to =
                idx(out.grid.id(static_cast<std::int32_t>(k % g.nx) / side,
                                (w.y_begin + static_cast<std::int32_t>(k / g.nx)) / side));
            out.vf_rad[to] += vf[i];
            ++count[to];
        }
    });
    for (std::size_t i = 0; i < count.size(); ++i) {
        out.vf_rad[i] = 2 * count[i] < side * side ? std::numeric_limits<float>::quiet_NaN()
                                                   : out.vf_rad[i] / static_cast<float>(count[i]);
    }
    return out;
}

}  // namespace vfplan
