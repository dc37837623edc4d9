#include "io/tables/field_file.h"

#include <cmath>
#include <limits>

#include "io/tables/crs.h"
#include "io/tables/shard_index.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

std::uint64_t u(std::int64_t i) { return static_cast<std::uint64_t>(i); }

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
    std::vector<h5::Source> sources;
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        const Window w = info.layout.tile_window(static_cast<std::int64_t>(t));
        sources.push_back({name_in_index(tiles[t]),
                           "vf",
                           {u(w.y_begin), u(w.x_begin)},
                           {u(w.y_end - w.y_begin), u(w.x_end - w.x_begin)}});
    }
    file.write_virtual<float>("vf", {u(g.ny), u(g.nx)}, sources,
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

FieldFile::FieldFile(const std::filesystem::path& path) : file_(path) {
    check_version(file_, path);
    info_.key = file_.text("/", "key");
    info_.summary = file_.text("/", "summary");
    info_.crs_wkt = read_crs(file_, info_.origin);
    const h5::Dims dims = file_.dims("vf");
    Grid& g = info_.layout.grid;
    g.ny = static_cast<std::int32_t>(dims.at(0));
    g.nx = static_cast<std::int32_t>(dims.at(1));
    g.cell_m = file_.number("vf", "cell_m");
    g.origin = {file_.number("vf", "grid_origin_x_m"), file_.number("vf", "grid_origin_y_m")};
    info_.layout.patch_cells = static_cast<std::int32_t>(file_.number("vf", "patch_cells"));
    info_.layout.tile_cells = static_cast<std::int32_t>(file_.number("vf", "tile_cells"));
    check_shards(path);
}

Raster<float> FieldFile::read(const Window& w) const {
    return file_.read_window<float>("vf", {u(w.y_begin), u(w.x_begin)},
                                    {u(w.y_end - w.y_begin), u(w.x_end - w.x_begin)});
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
