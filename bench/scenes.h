// Sites that the benchmarks stand in.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/config/config.h"
#include "engine/config/options.h"
#include "engine/tables/site.h"

namespace vfplan::bench {

// A site, ready for views, with the job that it is part of.
struct Scene {
    std::string name;
    Config config;
    Site site;
    Layout layout;
    Raster<std::uint8_t> standable;  // of the whole grid

    const std::vector<Wall>& walls() const { return site.walls; }
    const Box& extent() const { return site.extent; }
    const Grid& grid() const { return layout.grid; }
    Scanner scanner() const { return scene_options(config).scanner; }
};

// Side of the windows that threads take, cells.
inline constexpr std::int32_t window_cells = 32;

// Writes the site as work/site.h5 of a run directory.
void write_site(const Scene& scene, const std::filesystem::path& dir, const std::string& key);

// Made at first use:
//   town       generated, 637 buildings, 976 x 893 m, cells of 2 m, range 600 m, pieces of 5 m
//   flat       generated, 12 rooms, cells of 0.05 m, range 30 m, pieces of 0.1 m
//   city       generated, 1 km2, cells of 2 m, range 75 m, pieces of 1 m
//   bellevue   the real town of the town's size, with the town's parameters, from the data folder
//   office     a real floor, cells of 0.05 m, likewise
//   allegheny  25 km2 of a real city, with the city's parameters, likewise
// nullptr where the data are missing.
const Scene* scene(const std::string& name);

// Every n-th window of 32 x 32 cells that has standable cells: a sample of the field.
std::vector<Window> sample_windows(const Scene& scene, int every);

// Centres of the windows' standable cells, window by window.
std::vector<Vec2d> eyes_in(const Scene& scene, const std::vector<Window>& windows);

}  // namespace vfplan::bench
