// Small sites for the tests of candidates: walls, a field, ridges drawn by hand.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "engine/candidates.h"
#include "engine/graph.h"
#include "kernels/free_cells.h"
#include "kernels/skeleton.h"
#include "tests/kernels/scenes.h"

namespace vfplan::test {

// A counter-clockwise ring of walls with free space inside; `points` as x, y pairs.
inline Ring ring_of(const std::vector<std::pair<double, double>>& points) {
    Ring ring;
    for (const auto& [x, y] : points) ring.emplace_back(x, y);
    return ring;
}

inline Ring box_ring(double x0, double y0, double x1, double y1) {
    return ring_of({{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}});
}

struct World {
    struct Setting {
        Scanner scanner{0.1, 100, 90};
        double cell_m = 1;
        double partition_m = 1;
        double visible_fraction = 0.5;
        double threshold_rad = 0;
    };

    // The rings are walls and the even-odd bounds of free space; `partitions` are walls in it.
    World(const Setting& s, const std::vector<Ring>& rings,
          const std::vector<Wall>& partitions = {})
        : setting(s), outline(rings), walls(partitions) {
        for (const Ring& ring : rings) add_ring(walls, ring);
        const Box box = bounds_of(walls);
        grid = make_grid(box, s.cell_m, 0.001);
        standable = free_cells(grid, rings);
        closed = closed_links(grid, standable, walls);
        pieces = cut_into_pieces(walls, s.partition_m);
        kernel = kernel_named("exact", walls, box, s.scanner.range_max_m);
        viewer = std::make_unique<Viewer>(*kernel, walls, pieces, s.scanner, s.visible_fraction);
        field = visibility_field(*viewer, Threads(1), grid, standable, [](std::int64_t) {}).vf_rad;
        domain.resize(standable.size());
        for (std::size_t i = 0; i < domain.size(); ++i) {
            domain[i] = standable[i] != 0 && closed[i] == 0 &&
                        field[i] >= static_cast<float>(s.threshold_rad);
        }
    }

    World(const World&) = delete;  // the viewer refers to its walls
    World& operator=(const World&) = delete;

    const Ground& ground() const { return ground_; }
    std::int64_t cell(double x, double y) const {
        const Vec2d at = (Vec2d(x, y) - grid.origin) / grid.cell_m;
        return grid.id(static_cast<std::int32_t>(std::floor(at.x())),
                       static_cast<std::int32_t>(std::floor(at.y())));
    }
    bool free_at(const Vec2d& p) const {
        return free_cells({p - Vec2d(0.5, 0.5), 1, 1, 1}, outline)[0] != 0;
    }

    // A skeleton: cells along lines between points, one step at a time.
    RidgeGraph drawn(const std::vector<std::vector<std::pair<double, double>>>& lines) const {
        Raster<std::uint8_t> skeleton(standable.size(), 0);
        for (const auto& line : lines) {
            for (std::size_t i = 0; i < line.size(); ++i) {
                std::int64_t c = cell(line[i].first, line[i].second);
                skeleton[static_cast<std::size_t>(c)] = 1;
                if (i + 1 == line.size()) break;
                const std::int64_t to = cell(line[i + 1].first, line[i + 1].second);
                while (c != to) {
                    const auto step = [](std::int32_t d) { return d == 0 ? 0 : d > 0 ? 1 : -1; };
                    c = grid.id(grid.ix(c) + step(grid.ix(to) - grid.ix(c)),
                                grid.iy(c) + step(grid.iy(to) - grid.iy(c)));
                    skeleton[static_cast<std::size_t>(c)] = 1;
                }
            }
        }
        return ridge_graph(grid, skeleton);
    }
    // The true one.
    RidgeGraph ridges() const {
        DistanceField distance;
        distance.resize(grid.size());
        distance_columns(grid, domain, 0, grid.nx, distance);
        distance_rows(grid, domain, 0, grid.ny, distance);
        Raster<std::uint8_t> skeleton = thin(grid, domain, distance);
        prune_spurs(grid, distance, skeleton);
        return ridge_graph(grid, skeleton);
    }

    CandidateResult candidates(const RidgeGraph& ridges, const CandidateOptions& options = {},
                               int threads = 1) const {
        return find_candidates(*viewer, Threads(threads), ground(), ridges, options,
                               [](const char*) {});
    }

    Setting setting;
    std::vector<Ring> outline;
    std::vector<Wall> walls;
    Grid grid;
    Raster<std::uint8_t> standable, closed, domain;
    Pieces pieces;
    std::unique_ptr<ViewKernel> kernel;
    std::unique_ptr<Viewer> viewer;
    Raster<float> field;

private:
    Ground ground_{grid, field, standable, closed, domain};
};

inline World hall(double length = 20, double width = 10, World::Setting setting = {}) {
    return {setting, {box_ring(0, 0, length, width)}};
}

inline CandidateOptions overlap_of(double threshold, OverlapRatio ratio = OverlapRatio::mean_len) {
    CandidateOptions o;
    o.threshold = threshold;
    o.ratio = ratio;
    return o;
}

// The cells of one kind, ascending.
inline std::vector<std::int64_t> cells_of(const std::vector<Candidate>& candidates,
                                          CandidateKind kind) {
    std::vector<std::int64_t> out;
    for (const Candidate& c : candidates) {
        if (c.kind == kind) out.push_back(c.cell);
    }
    std::sort(out.begin(), out.end());
    return out;
}

inline bool row_has(const CoverageRow& row, std::int64_t piece) {
    return std::any_of(row.begin(), row.end(), [&](const Seen& s) { return s.piece == piece; });
}

}  // namespace vfplan::test
