#include "bench/scenes.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>

#include "engine/generate/generate.h"
#include "engine/tables/shards.h"
#include "engine/tables/standable.h"
#include "io/files.h"
#include "io/site/site_reader.h"
#include "io/tables/site_store.h"
#include "kernels/free_cells.h"
#include "kernels/index.h"

namespace vfplan::bench {
namespace {

std::filesystem::path data_file(const std::string& path) {
    const char* data = std::getenv("VFPLAN_DATA");
    return (data != nullptr ? std::filesystem::path(data)
                            : std::filesystem::path(VFPLAN_SOURCE_DIR) / ".." / "shared" / "data") /
           path;
}

Scene make_scene(const std::string& name, const std::string& job, const std::string& site) {
    Scene s;
    s.name = name;
    s.config = read_config(std::filesystem::path(VFPLAN_SOURCE_DIR) / "configs" / job,
                           {"site.input=" + site});
    s.site = read_site(s.config.site.input, ground_options(s.config).site).site;
    s.layout = layout_of(ground_options(s.config), s.site);
    s.standable = free_cells(s.grid(), s.site.free_border);
    return s;
}

Scene generated(const std::string& name, const std::string& job, const GenerateOptions& options) {
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("vfplan_bench_" + std::to_string(getpid()) + ".geojson");
    write_text(file, generate_site(options).geojson);
    Scene s = make_scene(name, job, file);
    std::filesystem::remove(file);
    return s;
}

}  // namespace

const Scene* scene(const std::string& name) {
    static std::map<std::string, std::unique_ptr<Scene>> made;
    const auto found = made.find(name);
    if (found != made.end()) return found->second.get();
    std::unique_ptr<Scene>& s = made[name];
    if (name == "town") {
        s = std::make_unique<Scene>(generated(name, "town.toml", {"town", 1, 2, 6}));
    } else if (name == "city") {
        s = std::make_unique<Scene>(generated(name, "city.toml", {"city", 1, 1, 6}));
    } else if (name == "flat") {
        s = std::make_unique<Scene>(generated(name, "flat.toml", {"flat", 1, 2, 12}));
    } else if (name == "bellevue") {
        const auto file = data_file("town_bellevue/bellevue_976x893.geojson");
        if (std::filesystem::exists(file)) {
            s = std::make_unique<Scene>(make_scene(name, "town.toml", file));
        }
    } else if (name == "office") {
        const auto file = data_file("plans_offices_schools/office_off_2.geojson");
        if (std::filesystem::exists(file)) {
            s = std::make_unique<Scene>(make_scene(name, "office.toml", file));
        }
    } else if (name == "allegheny") {
        const auto file = data_file("city_allegheny/allegheny_core_5km.geojson");
        if (std::filesystem::exists(file)) {
            s = std::make_unique<Scene>(make_scene(name, "city.toml", file));
        }
    }
    return s.get();
}

void write_site(const Scene& scene, const std::filesystem::path& dir, const std::string& key) {
    const Pieces pieces = cut_into_pieces(scene.walls(), scene.config.coverage.partition_m);
    SiteFacts facts;
    facts.origin = scene.site.origin;
    facts.summary = "{}";
    facts.walls = static_cast<std::int64_t>(scene.walls().size());
    facts.pieces = pieces.size();
    facts.extent = scene.extent();
    const GroundOptions ground = ground_options(scene.config);
    const double reach_m = wall_reach_m(ground.range_max_m, ground.partition_m, ground.site.snap_m);
    make_shard_folders(dir, ground.tile_cells);
    write_site_store(dir / "work" / "site.h5", key, scene.layout, facts, scene.walls(), pieces,
                     near_walls(scene.layout, scene.walls(), reach_m),
                     standable_bits(ground, scene.site, scene.layout, Threads(1)));
}

std::vector<Window> sample_windows(const Scene& scene, int every) {
    const Grid& g = scene.grid();
    std::vector<Window> out;
    int index = 0;
    for (std::int32_t y = 0; y < g.ny; y += window_cells) {
        for (std::int32_t x = 0; x < g.nx; x += window_cells) {
            const Window w{x, y, std::min(x + window_cells, g.nx),
                           std::min(y + window_cells, g.ny)};
            if (eyes_in(scene, {w}).empty() || index++ % every != 0) continue;
            out.push_back(w);
        }
    }
    return out;
}

std::vector<Vec2d> eyes_in(const Scene& scene, const std::vector<Window>& windows) {
    std::vector<Vec2d> out;
    for (const Window& w : windows) {
        for (std::int32_t iy = w.y_begin; iy < w.y_end; ++iy) {
            for (std::int32_t ix = w.x_begin; ix < w.x_end; ++ix) {
                const std::int64_t cell = scene.grid().id(ix, iy);
                if (scene.standable[idx(cell)] != 0) {
                    out.push_back(scene.grid().centre(cell));
                }
            }
        }
    }
    return out;
}

}  // namespace vfplan::bench
