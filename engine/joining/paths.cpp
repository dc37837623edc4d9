#include "engine/joining/paths.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "kernels/flood.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Of each two candidates the shortest path, of each two components the shortest few of these; by
// components, then the shortest first. What is in the result of all blocks is in that of its own.
std::vector<ShortestPath> shortest_few(std::vector<ShortestPath> paths) {
    std::sort(paths.begin(), paths.end(), [](const ShortestPath& a, const ShortestPath& b) {
        return std::tuple(a.components(), a.order()) < std::tuple(b.components(), b.order());
    });
    std::vector<ShortestPath> out;
    std::size_t first = 0;  // of the present components, in `out`
    for (ShortestPath& path : paths) {
        if (out.empty() || out.back().components() != path.components()) first = out.size();
        if (out.size() - first >= paths_tried) continue;
        const auto same = [&](const ShortestPath& w) {
            return w.candidates() == path.candidates();
        };
        if (std::any_of(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(), same)) {
            continue;
        }
        out.push_back(std::move(path));
    }
    return out;
}

double reach_cells(const TableJob& job) {
    return paths_reach_ranges * job.scenes.options().scanner.range_max_m / job.layout().grid.cell_m;
}
std::int32_t margin_of(double reach_cells) {
    return static_cast<std::int32_t>(std::ceil(reach_cells)) + 1;
}

// Around each block is looked as far as a path may reach: half of that wide, it is not much work.
Layout path_blocks(const Layout& layout, double reach_cells) {
    return in_blocks(layout, margin_of(reach_cells) / 2);
}

// The paths that meet in a block's cells.
std::vector<ShortestPath> paths_of_block(const TableJob& job, const FieldTiles& tiles,
                                         const CandidateList& candidates,
                                         const Components& components, std::int64_t block) {
    const Layout layout = path_blocks(job.layout(), reach_cells(job));
    const Window core = layout.tile_window(block);
    const Window around = core.grown(margin_of(reach_cells(job)), layout.grid);
    const CandidateList::Part list = candidates.in(around);
    const std::vector<std::int32_t> component = components.of(list.number);
    const auto same = [&](std::int32_t c) { return c == component.front(); };
    if (std::all_of(component.begin(), component.end(), same)) return {};
    const FieldWindow field = tiles.window(around);
    Raster<std::uint8_t> seeing(field.vf_rad.size());  // a path may lead over what sees anything
    for (std::size_t i = 0; i < seeing.size(); ++i) seeing[i] = field.vf_rad[i] > 0 ? 1 : 0;
    Flood flood(field.grid, seeing, field.closed, static_cast<std::int32_t>(10 * reach_cells(job)));
    for (std::size_t i = 0; i < list.candidates.size(); ++i) {
        const std::int64_t cell = list.candidates[i].cell;
        if (cell < 0) continue;
        const std::int32_t x = layout.grid.ix(cell);
        const std::int32_t y = layout.grid.iy(cell);
        if (!around.contains(x, y)) continue;
        flood.add_source(static_cast<std::int64_t>(field.index(x, y)),
                         static_cast<std::int32_t>(i));
    }
    flood.run();
    const auto whole = [&](std::int64_t cell) {
        return layout.grid.id(field.grid.ix(cell) + around.x_begin,
                              field.grid.iy(cell) + around.y_begin);
    };
    std::vector<ShortestPath> paths;
    std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> known;  // by candidates
    for (std::int32_t y = core.y_begin; y < core.y_end; ++y) {
        for (std::int32_t x = core.x_begin; x < core.x_end; ++x) {
            const auto cell = static_cast<std::int64_t>(field.index(x, y));
            if (flood.distance(cell) == Flood::unreached) continue;
            const std::int32_t a = flood.source(cell);
            for (std::int32_t k = 0; k < 4; ++k) {
                const std::int32_t nx = x + around_dx[k];
                const std::int32_t ny = y + around_dy[k];
                if ((field.closed[idx(cell)] >> k & 1U) != 0 || !around.contains(nx, ny)) continue;
                const auto n = static_cast<std::int64_t>(field.index(nx, ny));
                if (flood.distance(n) == Flood::unreached) continue;
                const std::int32_t b = flood.source(n);
                if (component[idx(a)] == component[idx(b)]) continue;
                const std::int32_t length =
                    flood.distance(cell) + flood.distance(n) + (k % 2 == 0 ? 10 : 14);
                const auto found = known.emplace(std::minmax(a, b), paths.size());
                if (!found.second && paths[found.first->second].length <= length) continue;
                if (found.second) paths.emplace_back();
                ShortestPath& path = paths[found.first->second];
                std::tie(path.component[0], path.component[1]) =
                    std::minmax(component[idx(a)], component[idx(b)]);
                std::tie(path.candidate[0], path.candidate[1]) =
                    std::minmax(list.number[idx(a)], list.number[idx(b)]);
                path.length = length;
                path.meets_at = whole(cell);
                path.direction = k;
                path.cells = {cell, n};  // as they lie in the window, until the path is asked for
            }
        }
    }
    paths = shortest_few(std::move(paths));
    for (ShortestPath& path : paths) {
        std::vector<std::int64_t> cells = flood.path_to(path.cells[0]);
        const std::vector<std::int64_t> rest = flood.path_to(path.cells[1]);
        cells.insert(cells.end(), rest.rbegin(), rest.rend());
        for (std::int64_t& cell : cells) cell = whole(cell);
        path.cells = std::move(cells);
    }
    return paths;
}

}  // namespace

double paths_task_bytes(const Layout& layout, double range_cells) {
    constexpr double cell_bytes = 20;  // field, who sees anything, what is closed, the flood
    const double reach = paths_reach_ranges * range_cells;
    return cell_bytes * path_blocks(layout, reach).largest_window_cells(margin_of(reach));
}

std::vector<ShortestPath> make_paths(const TableJob& job, const FieldTiles& field,
                                     const CandidateList& candidates,
                                     const Components& components) {
    if (components.count() < 2) return {};
    const std::int64_t blocks = path_blocks(job.layout(), reach_cells(job)).tiles();
    const ShardNames names = job.passing("paths");
    make_shards(
        job, names, blocks,
        [&](std::int64_t block, const std::filesystem::path& path) {
            write_paths(path, job.key, paths_of_block(job, field, candidates, components, block));
        },
        paths_task_bytes(job.layout(), job.range_cells()));
    make_one(job, names.phase(), names.whole(), [&](const std::filesystem::path& path) {
        std::vector<ShortestPath> all;
        for (std::int64_t block = 0; block < blocks; ++block) {
            for (ShortestPath& p : read_paths(names.one(block))) all.push_back(std::move(p));
        }
        write_paths(path, job.key, shortest_few(std::move(all)));
    });
    return read_paths(names.whole());
}

}  // namespace vfplan
