#include "engine/skeleton_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "engine/field_tiles.h"
#include "kernels/error.h"
#include "kernels/index.h"
#include "kernels/skeleton.h"

namespace vfplan {
namespace {

std::filesystem::path graph_path(const Work& work) { return work.passing("graph", 0); }

// The skeleton cells of a window; false when what lies around it was too little to tell.
bool thin_window(const Work& work, const Window& core, const Window& around, SkeletonCells& out) {
    const Grid& grid = work.layout().grid;
    const FieldWindow field = read_field_window(work.dir, work.layout(), around);
    const Raster<std::uint8_t> domain = field.domain(work.config.field.threshold_rad);
    DistanceField distance;
    distance.resize(field.grid.size());
    work.threads.for_each(field.grid.nx, 64, [&](std::int64_t from, std::int64_t to) {
        distance_columns(field.grid, domain, static_cast<std::int32_t>(from),
                         static_cast<std::int32_t>(to), distance);
    });
    work.threads.for_each(field.grid.ny, 64, [&](std::int64_t from, std::int64_t to) {
        distance_rows(field.grid, domain, static_cast<std::int32_t>(from),
                      static_cast<std::int32_t>(to), distance);
    });
    PartOfGrid part{
        around.x_begin,
        around.y_begin,
        {around.x_begin > 0, around.y_begin > 0, around.x_end < grid.nx, around.y_end < grid.ny}};
    const std::vector<Cell> state = thin(field.grid, domain, distance, part);
    out = {};
    for (std::int32_t y = core.y_begin; y < core.y_end; ++y) {
        for (std::int32_t x = core.x_begin; x < core.x_end; ++x) {
            const std::size_t i = field.index(x, y);
            if (state[i] == Cell::unknown) return false;
            if (state[i] == Cell::absent) continue;
            out.cell.push_back(grid.id(x, y));
            out.squared.push_back(distance.squared[i]);
        }
    }
    return true;
}

}  // namespace

void make_skeleton_tiles(const Work& work) {
    const Layout& layout = work.layout();
    make_shards(
        work, "skeleton", layout.tiles(),
        [&](std::int64_t tile) { return work.passing("skeleton", tile); },
        [&](std::int64_t tile, const std::filesystem::path& path) {
            // Walls are nearer than the range to every cell of the domain.
            constexpr std::int32_t beyond = 48;
            const Window core = layout.tile_window(tile);
            SkeletonCells cells;
            for (std::int32_t margin = work.range_cells() + beyond;
                 !thin_window(work, core, core.grown(margin, layout.grid), cells); margin *= 2) {
            }
            h5::Writer file = shard_writer(path, work.key);
            file.write("cell", cells.cell);
            file.write("squared", cells.squared);
            finish_shard(file);
        });
}

void make_ridge_graph(const Work& work, bool needed) {
    make_shard(work, "graph", graph_path(work), [&](const std::filesystem::path& path) {
        const Layout& layout = work.layout();
        SkeletonCells all;
        {
            std::vector<std::pair<std::int64_t, std::int32_t>> cells;
            for (std::int64_t tile = 0; tile < layout.tiles(); ++tile) {
                const h5::Reader file(work.passing("skeleton", tile));
                const auto cell = file.read<std::int64_t>("cell");
                const auto squared = file.read<std::int32_t>("squared");
                for (std::size_t i = 0; i < cell.size(); ++i) {
                    cells.emplace_back(cell[i], squared[i]);
                }
            }
            std::sort(cells.begin(), cells.end());
            for (const auto& [cell, squared] : cells) {
                all.cell.push_back(cell);
                all.squared.push_back(squared);
            }
        }
        prune_spurs(layout.grid, all);
        const RidgeGraph graph = ridge_graph(layout.grid, all);
        all = {};
        if (needed && graph.joints.empty() && graph.ridges.empty()) {
            throw UsageError(fmt::format(
                "field.threshold_rad = {}: no cell sees that much wall between range_min_m = {} "
                "and range_max_m = {}; lower the threshold or raise range_max_m",
                work.config.field.threshold_rad, work.config.scanner.range_min_m,
                work.config.scanner.range_max_m));
        }
        // By tile, the joints by their cell, the ridges by their first one.
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
        std::vector<std::int64_t> joint_begin(at(layout.tiles()) + 1, 0);
        std::vector<std::int64_t> ridge_begin(joint_begin.size(), 0);
        for (const std::int64_t j : joints) ++joint_begin[at(layout.tile_of(j)) + 1];
        for (const std::size_t r : order) ++ridge_begin[at(tile_of(r)) + 1];
        std::partial_sum(joint_begin.begin(), joint_begin.end(), joint_begin.begin());
        std::partial_sum(ridge_begin.begin(), ridge_begin.end(), ridge_begin.begin());
        std::vector<std::int64_t> cells_begin = {0};
        std::vector<std::int64_t> cells;
        std::vector<std::int64_t> first_joint;
        std::vector<std::int64_t> last_joint;
        std::vector<std::uint8_t> ring;
        const auto joint_cell = [&](std::int32_t j) { return j < 0 ? -1 : graph.joints[at(j)]; };
        for (const std::size_t r : order) {
            const Ridge& ridge = graph.ridges[r];
            cells.insert(cells.end(), ridge.cells.begin(), ridge.cells.end());
            cells_begin.push_back(static_cast<std::int64_t>(cells.size()));
            first_joint.push_back(joint_cell(ridge.joint[0]));
            last_joint.push_back(joint_cell(ridge.joint[1]));
            ring.push_back(ridge.ring ? 1 : 0);
        }
        constexpr std::uint64_t chunk = 1U << 14;
        h5::Writer file = shard_writer(path, work.key);
        file.write("joints", joints, {}, chunk);
        file.write("joint_begin", joint_begin);
        file.write("ridge_begin", ridge_begin);
        file.write("cells_begin", cells_begin, {}, chunk);
        file.write("cells", cells, {}, chunk);
        file.write("first_joint", first_joint, {}, chunk);
        file.write("last_joint", last_joint, {}, chunk);
        file.write("ring", ring, {}, chunk);
        finish_shard(file);
    });
}

TileRidges read_tile_ridges(const Work& work, std::int64_t tile) {
    const h5::Reader file(graph_path(work));
    const auto range = [&](const char* name, std::int64_t row) {
        const auto two = file.read<std::int64_t>(name, static_cast<std::uint64_t>(row), 2);
        return std::pair(static_cast<std::uint64_t>(two[0]),
                         static_cast<std::uint64_t>(two[1] - two[0]));
    };
    TileRidges out;
    const auto [joint_from, joint_count] = range("joint_begin", tile);
    out.joints = file.read<std::int64_t>("joints", joint_from, joint_count);
    const auto [from, count] = range("ridge_begin", tile);
    const auto begin = file.read<std::int64_t>("cells_begin", from, count + 1);
    const auto cells =
        file.read<std::int64_t>("cells", static_cast<std::uint64_t>(begin.front()),
                                static_cast<std::uint64_t>(begin.back() - begin.front()));
    const auto first = file.read<std::int64_t>("first_joint", from, count);
    const auto last = file.read<std::int64_t>("last_joint", from, count);
    const auto ring = file.read<std::uint8_t>("ring", from, count);
    for (std::size_t r = 0; r < count; ++r) {
        out.ridges.push_back({{cells.begin() + (begin[r] - begin.front()),
                               cells.begin() + (begin[r + 1] - begin.front())},
                              {first[r], last[r]},
                              ring[r] != 0});
    }
    return out;
}

RidgeCounts count_ridges(const Work& work) {
    const h5::Reader file(graph_path(work));
    return {static_cast<std::int64_t>(file.dims("joints").at(0)),
            static_cast<std::int64_t>(file.dims("ring").at(0))};
}

}  // namespace vfplan
