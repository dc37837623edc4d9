#include "io/tables/ridge_shards.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "io/h5_reader.h"
#include "io/tables/sound.h"
#include "kernels/index.h"

namespace vfplan {

void write_skeleton_tile(const std::filesystem::path& path, const std::string& key,
                         const SkeletonCells& cells) {
    h5::Writer file = begin_shard(path, key);
    file.write("cell", cells.cell);
    file.write("squared", cells.squared);
    finish_shard(file);
}

SkeletonCells SkeletonTiles::all() const {
    std::vector<std::pair<std::int64_t, std::int32_t>> cells;
    for (std::int64_t tile = 0; tile < layout_.tiles(); ++tile) {
        const h5::Reader file(names_.one(tile));
        const auto cell = file.read<std::int64_t>("cell");
        const auto squared = file.read<std::int32_t>("squared");
        sound::range(file, "cell", cell, 0, layout_.grid.size());
        sound::count(file, "squared", squared, cell.size());
        for (std::size_t i = 0; i < cell.size(); ++i) cells.emplace_back(cell[i], squared[i]);
    }
    std::sort(cells.begin(), cells.end());
    SkeletonCells out;
    for (const auto& [cell, squared] : cells) {
        out.cell.push_back(cell);
        out.squared.push_back(squared);
    }
    return out;
}

void write_ridges(const std::filesystem::path& path, const std::string& key, const Layout& layout,
                  const RidgeGraph& graph) {
    std::vector<std::size_t> order(graph.ridges.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto tile_of = [&](std::size_t r) {
        return layout.tile_of(graph.ridges[r].cells.front());
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return tile_of(a) < tile_of(b); });
    std::vector<std::int64_t> joints = graph.joints;
    std::sort(joints.begin(), joints.end(), [&](std::int64_t a, std::int64_t b) {
        return std::pair(layout.tile_of(a), a) < std::pair(layout.tile_of(b), b);
    });
    std::vector<std::int64_t> joint_begin(idx(layout.tiles()) + 1, 0);
    std::vector<std::int64_t> ridge_begin(joint_begin.size(), 0);
    for (const std::int64_t j : joints) ++joint_begin[idx(layout.tile_of(j)) + 1];
    for (const std::size_t r : order) ++ridge_begin[idx(tile_of(r)) + 1];
    std::partial_sum(joint_begin.begin(), joint_begin.end(), joint_begin.begin());
    std::partial_sum(ridge_begin.begin(), ridge_begin.end(), ridge_begin.begin());
    std::vector<std::int64_t> cells_begin = {0};
    std::vector<std::int64_t> cells;
    std::vector<std::int64_t> first_joint;
    std::vector<std::int64_t> last_joint;
    std::vector<std::uint8_t> ring;
    const auto joint_cell = [&](std::int32_t j) { return j < 0 ? -1 : graph.joints[idx(j)]; };
    for (const std::size_t r : order) {
        const Ridge& ridge = graph.ridges[r];
        cells.insert(cells.end(), ridge.cells.begin(), ridge.cells.end());
        cells_begin.push_back(static_cast<std::int64_t>(cells.size()));
        first_joint.push_back(joint_cell(ridge.joint[0]));
        last_joint.push_back(joint_cell(ridge.joint[1]));
        ring.push_back(ridge.ring ? 1 : 0);
    }
    constexpr std::uint64_t chunk = 1U << 14;
    h5::Writer file = begin_shard(path, key);
    file.write("joints", joints, {}, chunk);
    file.write("joint_begin", joint_begin);
    file.write("ridge_begin", ridge_begin);
    file.write("cells_begin", cells_begin, {}, chunk);
    file.write("cells", cells, {}, chunk);
    file.write("first_joint", first_joint, {}, chunk);
    file.write("last_joint", last_joint, {}, chunk);
    file.write("ring", ring, {}, chunk);
    finish_shard(file);
}

TileRidges RidgeTiles::tile(std::int64_t tile) const {
    const h5::Reader file(file_);
    const auto range = [&](const char* name) {
        const auto two = file.read<std::int64_t>(name, idx(tile), 2);
        sound::need(file, two[0] >= 0 && two[0] <= two[1], name, "does not ascend");
        return std::pair<std::uint64_t, std::uint64_t>(idx(two[0]), idx(two[1] - two[0]));
    };
    TileRidges out;
    const auto [joint_from, joint_count] = range("joint_begin");
    out.joints = file.read<std::int64_t>("joints", joint_from, joint_count);
    const auto [from, count] = range("ridge_begin");
    const auto begin = file.read<std::int64_t>("cells_begin", from, count + 1);
    sound::need(file, begin.front() >= 0, "cells_begin", "begins before its cells");
    for (std::size_t r = 0; r < count; ++r) {
        sound::need(file, begin[r] < begin[r + 1], "cells_begin", "does not ascend");
    }
    const auto cells =
        file.read<std::int64_t>("cells", idx(begin.front()), idx(begin.back() - begin.front()));
    const auto first = file.read<std::int64_t>("first_joint", from, count);
    const auto last = file.read<std::int64_t>("last_joint", from, count);
    const auto ring = file.read<std::uint8_t>("ring", from, count);
    sound::range(file, "joints", out.joints, 0, layout_.grid.size());
    sound::range(file, "cells", cells, 0, layout_.grid.size());
    sound::range(file, "first_joint", first, -1, layout_.grid.size());
    sound::range(file, "last_joint", last, -1, layout_.grid.size());
    for (std::size_t r = 0; r < count; ++r) {
        out.ridges.push_back({{cells.begin() + (begin[r] - begin.front()),
                               cells.begin() + (begin[r + 1] - begin.front())},
                              {first[r], last[r]},
                              ring[r] != 0});
    }
    return out;
}

std::int64_t RidgeTiles::joints() const {
    return static_cast<std::int64_t>(h5::Reader(file_).dims("joints").at(0));
}

std::int64_t RidgeTiles::ridges() const {
    return static_cast<std::int64_t>(h5::Reader(file_).dims("ring").at(0));
}

}  // namespace vfplan
