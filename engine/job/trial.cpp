#include "engine/job/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "engine/job/tables.h"
#include "engine/pool/pool.h"
#include "engine/runtime/progress.h"
#include "engine/runtime/ranks.h"
#include "engine/tables/field.h"
#include "engine/tables/site.h"
#include "engine/tables/skeleton.h"
#include "io/tables/coverage_file.h"
#include "io/temporary_folder.h"

namespace vfplan {
namespace {

// What files hold, without the bytes that each has however little it holds.
double bytes_below(const std::filesystem::path& folder, const std::string& prefix, double of_each) {
    double sum = 0;
    for (const auto& e : std::filesystem::recursive_directory_iterator(folder)) {
        if (e.is_regular_file() && e.path().filename().string().starts_with(prefix)) {
            sum += std::max(0.0, static_cast<double>(e.file_size()) - of_each);
        }
    }
    return sum;
}

constexpr double phase_s = 0.003;  // of a phase that has next to nothing to do
constexpr double field_bytes = 10000;
constexpr double coverage_bytes = 6000;
constexpr double site_bytes = 76000;
constexpr double passing_bytes = 2000;

}  // namespace

Trial try_part(const GroundOptions& ground, const TableOptions& options, const Site& part,
               const Threads& threads) {
    const std::string key = "estimate";
    const TemporaryFolder folder("vfplan-estimate");
    const Ranks alone{Ranks::Alone{}};
    Progress quiet(true);
    make_shard_folders(folder.path(), options.tile_cells);
    quiet.stage("site");
    store_site(ground, key, part, {}, threads, site_store_path(folder.path()), true);

    const SiteStore site(site_store_path(folder.path()), options.tile_cells);
    const int scenes_kept = 8 + 8 * threads.count();
    Scenes scenes(
        site.layout(), [&](std::int64_t patch) { return site.patch(patch); }, options.scenes,
        scenes_kept);
    const std::filesystem::path dir = folder.path();
    const TableJob job{dir, key, threads, alone, quiet, scenes};
    const FieldTiles field = make_field(job, site);
    const SkeletonTiles skeleton = make_skeleton(job, field, options.threshold_rad);
    const RidgeTiles ridges = make_ridges(job, skeleton);
    Trial out;
    out.cells = static_cast<double>(site.layout().grid.size());
    out.free_cells = static_cast<double>(site.facts().free_cells);
    if (ridges.joints() > 0 || ridges.ridges() > 0) {
        make_coverage_table(job, site, field, ridges, options);
        CandidatePool with = CandidatePool::axis;
        if (options.pool) {
            with = CandidatePool::pool;
            PoolOptions pool = *options.pool;
            pool.scenes = options.scenes;
            make_field_index(job, site, field);
            make_pool(dir, pool, threads, alone, quiet);
        }
        const CoverageTables tables = read_candidates(dir, with).tables;
        out.candidates = static_cast<double>(tables.rows());
        out.entries = static_cast<double>(tables.entries());
    }
    quiet.finish();
    for (const StageTime& t : quiet.times()) {
        out.cpu_s[t.name] += std::max(0.0, t.cpu_s - phase_s);
    }
    out.field_bytes = bytes_below(dir / "shards", "field", field_bytes);
    out.coverage_bytes = bytes_below(dir / "shards", "coverage", coverage_bytes) +
                         bytes_below(dir / "shards", "pool", coverage_bytes);
    const std::filesystem::path passing =
        dir / "work" / fmt::format("tiles-{}", options.tile_cells);
    out.working_bytes =
        bytes_below(dir / "work", "site", site_bytes) + bytes_below(passing, "", passing_bytes);
    return out;
}

}  // namespace vfplan
