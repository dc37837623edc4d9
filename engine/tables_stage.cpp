#include "engine/tables_stage.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/candidate_tiles.h"
#include "engine/coverage_blocks.h"
#include "engine/field_tiles.h"
#include "engine/links.h"
#include "engine/site_stage.h"
#include "engine/skeleton_tiles.h"
#include "engine/work.h"
#include "io/tables.h"
#include "kernels/embree_scene.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

// What the field cost in operations. For the rays "steps" are rays.
Json field_summary(const Config& config, const FieldCounts& c) {
    Json j = {{"kernel", config.visibility.kernel}, {"cells", c.cells}};
    const double cells = static_cast<double>(std::max<std::int64_t>(1, c.cells));
    if (config.visibility.kernel == "embree") {
        j["packets"] = c.packets;
        j["rays"] = c.steps;
        j["rays_per_view"] = static_cast<double>(c.steps) / cells;
    }
    return {{"field_work", j}};
}

void write_field_table(const Work& work) {
    make_shard(work, "tables", work.dir / "field.h5", [&](const std::filesystem::path& path) {
        const Layout& layout = work.layout();
        std::vector<std::filesystem::path> tiles;
        for (std::int64_t t = 0; t < layout.tiles(); ++t) {
            tiles.push_back(field_shard(work.dir, layout, t));
        }
        write_field_index(path,
                          {layout, work.store.facts().origin, work.store.facts().crs_wkt, work.key,
                           field_summary(work.config, count_field(work)).dump()},
                          tiles);
    });
}

void make_coverage(const Work& work) {
    make_skeleton_tiles(work);
    make_ridge_graph(work, work.config.plan.required.empty() && work.config.plan.existing.empty());
    make_seeds(work);
    make_ridge_points(work);
    make_rescue(work);
    CandidateReport report;
    add_candidate_counts(work, report);
    report.rescued_pieces = rescued_pieces(work);
    make_links(work, report);
    const std::int64_t blocks = make_coverage_blocks(work);
    Json summary = Json::parse(work.store.facts().summary);
    summary["candidate_search"] = {{"joints", report.joints},
                                   {"ridges", report.ridges},
                                   {"ridges_short_of_overlap", report.ridges_short_of_overlap},
                                   {"rescued_pieces", report.rescued_pieces},
                                   {"parts_before_links", report.parts_before_links},
                                   {"parts", report.parts}};
    write_coverage_tables(work, blocks, summary.dump());
}

// An index of this job whose shards are all there; otherwise it is named and removed.
bool index_complete(const std::filesystem::path& path, const std::string& key, Progress& progress) {
    if (!have_shard(path, key, progress)) return false;
    try {
        check_shards(path);
        return true;
    } catch (const IoError& e) {
        note_made_again(e.what(), progress);
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
        return false;
    }
}

}  // namespace

Scanner scanner_of(const Config& c) {
    return {c.scanner.range_min_m, c.scanner.range_max_m, c.scanner.max_incidence_deg};
}

OverlapRatio ratio_of(const std::string& name) {
    const auto found = std::find(overlap_ratio_names.begin(), overlap_ratio_names.end(), name);
    return static_cast<OverlapRatio>(found - overlap_ratio_names.begin());
}

int rays_of(const Config& c) {
    if (c.visibility.rays > 0) return static_cast<int>(c.visibility.rays);
    return default_rays(c.scanner.range_max_m, c.coverage.partition_m);
}

SceneOptions scene_options(const Config& c) {
    return {scanner_of(c), c.visibility.kernel, rays_of(c), c.coverage.visible_fraction,
            c.coverage.partition_m};
}

bool tables_complete(const std::filesystem::path& dir, const std::string& key, Progress& progress) {
    const bool field = index_complete(dir / "field.h5", key, progress);
    const bool coverage = index_complete(dir / "coverage.h5", key, progress);
    return field && coverage;
}

void make_site(const Config& config, const std::filesystem::path& dir, const std::string& key,
               const Threads& threads, Progress& progress) {
    const std::filesystem::path site = dir / "work" / "site.h5";
    if (have_shard(site, key, progress)) return;
    store_site(config, key, read_job_site(config, threads, progress), threads, site);
    malloc_trim(0);  // of what reading took, nothing is needed any more
}

void make_tables(const Config& config, const std::filesystem::path& dir, const std::string& key,
                 const Threads& threads, const Ranks& ranks, Progress& progress) {
    ranks.lead([&] {
        std::filesystem::create_directories(dir / "work" /
                                            fmt::format("tiles-{}", config.field.tile_cells));
    });
    const SiteStore store(dir / "work" / "site.h5", config.field.tile_cells);
    const int kept = 8 + 8 * threads.count();  // a tile and its surroundings for each
    Scenes scenes(
        store.layout(), [&](std::int64_t patch) { return store.patch(patch); },
        scene_options(config), kept);
    const Work work{config, dir, key, threads, ranks, progress, store, scenes};
    make_field_tiles(work);
    write_field_table(work);
    const std::filesystem::path coverage = dir / "coverage.h5";
    ranks.lead([&] { index_complete(coverage, key, progress); });  // gone after this, or good
    if (!std::filesystem::exists(coverage)) make_coverage(work);
}

}  // namespace vfplan
