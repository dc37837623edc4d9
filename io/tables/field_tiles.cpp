#include "io/tables/field_tiles.h"

#include "io/h5_reader.h"
#include "kernels/index.h"

namespace vfplan {

void write_field_tile(const std::filesystem::path& path, const std::string& key,
                      const FieldTile& tile) {
    h5::Writer file = begin_shard(path, key);
    const Window& w = tile.window;
    const h5::Dims shape = {idx(w.y_end - w.y_begin), idx(w.x_end - w.x_begin)};
    file.write("vf", tile.vf_rad, shape);
    file.write("closed", tile.closed, shape);
    file.attribute(
        "closed", "meaning",
        "bit k: a wall parts the cell from its neighbour k, counter-clockwise from east");
    file.attribute("/", "x_begin", std::int64_t{w.x_begin});
    file.attribute("/", "y_begin", std::int64_t{w.y_begin});
    file.attribute("/", "cells", tile.counts.cells);
    file.attribute("/", "packets", tile.counts.packets);
    file.attribute("/", "steps", tile.counts.steps);
    file.attribute("/", "walls", tile.counts.walls);
    finish_shard(file);
}

bool FieldWindow::in_domain(std::size_t i, double threshold_rad) const {
    // Also with a threshold of 0 a cell must see something; NaN is never above.
    return closed[i] == 0 && vf_rad[i] > 0 && vf_rad[i] >= static_cast<float>(threshold_rad);
}

Raster<std::uint8_t> FieldWindow::domain(double threshold_rad) const {
    Raster<std::uint8_t> out(vf_rad.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = in_domain(i, threshold_rad) ? 1 : 0;
    return out;
}

FieldWindow FieldTiles::window(const Window& window) const {
    FieldWindow out;
    out.window = window;
    out.grid = part_of(layout_.grid, window);
    out.vf_rad.resize(idx(window.size()));
    out.closed.resize(idx(window.size()));
    for (const std::int64_t tile : layout_.tiles_in(window)) {
        const Window whole = layout_.tile_window(tile);
        const Window part = shared(whole, window);
        const h5::Reader file(names_.one(tile));
        const std::array<std::uint64_t, 2> from = {idx(part.y_begin - whole.y_begin),
                                                   idx(part.x_begin - whole.x_begin)};
        const std::array<std::uint64_t, 2> shape = {idx(part.y_end - part.y_begin),
                                                    idx(part.x_end - part.x_begin)};
        copy_shared(part, file.read_window<float>("vf", from, shape), window, out.vf_rad);
        copy_shared(part, file.read_window<std::uint8_t>("closed", from, shape), window,
                    out.closed);
    }
    return out;
}

FieldCounts FieldTiles::counts() const {
    FieldCounts all;
    for (const std::filesystem::path& shard : shards()) {
        const h5::Reader file(shard);
        const auto number = [&](const char* name) { return file.whole("/", name); };
        all += {number("cells"), number("packets"), number("steps"), number("walls")};
    }
    return all;
}

std::vector<std::filesystem::path> FieldTiles::shards() const {
    std::vector<std::filesystem::path> out;
    for (std::int64_t t = 0; t < layout_.tiles(); ++t) out.push_back(names_.one(t));
    return out;
}

}  // namespace vfplan
