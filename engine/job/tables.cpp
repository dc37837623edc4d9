#include "engine/job/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/folder/contents.h"
#include "engine/joining/components.h"
#include "engine/joining/connectors.h"
#include "engine/joining/joins.h"
#include "engine/joining/paths.h"
#include "engine/tables/coverage.h"
#include "engine/tables/field.h"
#include "engine/tables/joints.h"
#include "engine/tables/rescues.h"
#include "engine/tables/skeleton.h"
#include "engine/tables/splits.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* index_phase = "tables";

// What the field cost in operations. For the rays "steps" are rays.
Json field_summary(KernelKind kernel, const FieldCounts& c) {
    Json j = {{"kernel", name_of(kernel)}, {"cells", c.cells}};
    const double cells = static_cast<double>(std::max<std::int64_t>(1, c.cells));
    if (kernel == KernelKind::embree) {
        j["packets"] = c.packets;
        j["rays"] = c.steps;
        j["rays_per_view"] = static_cast<double>(c.steps) / cells;
    }
    return {{"field_work", j}};
}

void make_coverage_index(const TableJob& job, const SiteStore& site,
                         const std::vector<std::filesystem::path>& blocks, const Json& search,
                         const Apart& apart) {
    make_one(job, index_phase, job.dir / coverage_name, [&](const std::filesystem::path& path) {
        const SiteFacts& facts = site.facts();
        Json summary = Json::parse(facts.summary);
        summary["candidate_search"] = search;
        const std::vector<Wall> walls = site.all_walls();
        write_coverage_index(path, walls, site.all_pieces(walls), blocks,
                             {facts.origin, facts.crs_wkt, job.key, summary.dump(), apart});
    });
}

// The user's points with their kind.
std::vector<Candidate> points_of_user(const TableOptions& options) {
    std::vector<Candidate> out;
    for (const Vec2d& p : options.required) out.push_back({p, -1, CandidateKind::required, 0});
    for (const Vec2d& p : options.existing) out.push_back({p, -1, CandidateKind::existing, 0});
    return out;
}

// Throws UsageError where there is nothing to choose candidates from.
void check_ridges(const TableJob& job, const RidgeTiles& ridges, const TableOptions& options) {
    if (!options.required.empty() || !options.existing.empty()) return;
    job.ranks.lead([&] {
        if (ridges.joints() > 0 || ridges.ridges() > 0) return;
        const Scanner& scanner = options.scenes.scanner;
        throw UsageError(fmt::format(
            "field.threshold_rad = {}: no cell sees that much wall between range_min_m = {} "
            "and range_max_m = {}; lower the threshold or raise range_max_m",
            options.threshold_rad, scanner.range_min_m, scanner.range_max_m));
    });
}

}  // namespace

void make_field_index(const TableJob& job, const SiteStore& site, const FieldTiles& field) {
    make_one(job, index_phase, job.dir / field_name, [&](const std::filesystem::path& path) {
        const Json summary = field_summary(job.scenes.options().kernel, field.counts());
        write_field_index(
            path,
            {field.layout(), site.facts().origin, site.facts().crs_wkt, job.key, summary.dump()},
            field.shards());
    });
}

bool tables_complete(const std::filesystem::path& dir, const std::string& key, Progress& progress) {
    const bool field = have_table(dir / field_name, key, progress);
    const bool coverage = have_table(dir / coverage_name, key, progress);
    return field && coverage;
}

void make_coverage_table(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                         const RidgeTiles& ridges, const TableOptions& options) {
    const std::int64_t pieces = site.facts().pieces;
    const std::vector<Candidate> of_user = points_of_user(options);
    const OverlapRule& rule = options.overlap;

    const FoundTiles joints = make_joints(job, ridges, pieces);
    const FoundTiles splits = make_splits(job, ridges, joints, of_user, rule, pieces);
    const CandidateList rescued =
        make_rescues(job, site, field, joints, splits, of_user, options.threshold_rad);
    const Components components = make_components(job, rescued, rule);
    const std::vector<ShortestPath> paths = make_paths(job, field, rescued, components);
    const CandidateList connected = make_connectors(job, rescued, components, paths, of_user, rule);
    const Joins joins = make_joins(job, site, field, connected, of_user, rule);
    const std::vector<std::filesystem::path> blocks =
        make_coverage(job, field, "coverage", joins.candidates);

    make_coverage_index(job, site, blocks,
                        {{"joints", ridges.joints()},
                         {"ridges", ridges.ridges()},
                         {"arcs_short_of_overlap", splits.short_of_overlap()},
                         {"rescued_pieces", rescued.counts().rescued_pieces},
                         {"components_before_connectors", components.count()},
                         {"components", joins.candidates.counts().components}},
                        joins.apart);
}

void make_tables(const TableOptions& of_job, const std::filesystem::path& dir,
                 const std::string& key, const Threads& threads, const Ranks& ranks,
                 Progress& progress) {
    ranks.lead([&] { make_shard_folders(dir, of_job.tile_cells); });
    const SiteStore site(site_store_path(dir), of_job.tile_cells);
    TableOptions options = of_job;
    options.required = site.facts().required;
    options.existing = site.facts().existing;
    const int scenes_kept = 8 + 8 * threads.count();  // a tile and its surroundings for each
    Scenes scenes(
        site.layout(), [&](std::int64_t patch) { return site.patch(patch); }, options.scenes,
        scenes_kept);
    const TableJob job{dir, key, threads, ranks, progress, scenes};

    const FieldTiles field = make_field(job, site);
    make_field_index(job, site, field);
    ranks.lead(
        [&] { have_table(dir / coverage_name, key, progress); });  // gone after this, or good
    if (std::filesystem::exists(dir / coverage_name)) return;
    const SkeletonTiles skeleton = make_skeleton(job, field, options.threshold_rad);
    const RidgeTiles ridges = make_ridges(job, skeleton);
    check_ridges(job, ridges, options);
    make_coverage_table(job, site, field, ridges, options);
}

}  // namespace vfplan
