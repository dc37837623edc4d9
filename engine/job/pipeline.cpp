#include "engine/job/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/config/parameters.h"
#include "engine/folder/claim.h"
#include "engine/folder/contents.h"
#include "engine/folder/input_state.h"
#include "engine/folder/publication.h"
#include "engine/folder/run_dir.h"
#include "engine/job/estimate.h"
#include "engine/job/needs.h"
#include "engine/job/result_hash.h"
#include "engine/job/summary.h"
#include "engine/job/tables.h"
#include "engine/plan/planning.h"
#include "engine/pool/pool.h"
#include "engine/runtime/stop.h"
#include "engine/tables/site.h"
#include "io/exports/outputs.h"
#include "io/files.h"
#include "io/tables/plan_file.h"
#include "io/tables/site_store.h"
#include "kernels/coverage.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

// From a site to its tables, on all ranks: field.h5 and coverage.h5, as far as they are missing.
void tables_of(const RunDir& dir, const Config& config, const JobKeys& keys,
               const InputState& input, bool plan, const Threads& threads, const Ranks& ranks,
               Progress& progress) {
    ranks.lead([&] {
        if (tables_complete(dir.path(), keys.tables, progress)) return;
        dir.remove_plan();
        const GroundOptions ground = ground_options(config);
        make_site(
            ground, dir.path(), keys.tables, threads, progress,
            [&](const Site& site, const Layout& layout) {
                const auto pieces = cut_into_pieces(site.walls, ground.partition_m).size();
                check_memory(ground, layout, pieces, plan, memory_limit());
            },
            [&] { input.check_unchanged(); });
    });
    if (std::filesystem::exists(dir.file(field_name)) &&
        std::filesystem::exists(dir.file(coverage_name))) {
        progress.note("tables       of this job are complete in the folder and used as they are");
        return;
    }
    make_tables(table_options(config), dir.path(), keys.tables, threads, ranks, progress);
}

// pool.h5, as far as it is missing and asked for; on all ranks.
void add_pool(const RunDir& dir, const Config& config, const Threads& threads, const Ranks& ranks,
              Progress& progress) {
    const TableOptions options = table_options(config);
    if (options.pool) make_pool(dir.path(), *options.pool, threads, ranks, progress);
}

// The files that are asked for, each by one thread; what is not asked for does not stay from a plan
// before.
void write_outputs(const RunDir& dir, const std::vector<std::string>& formats,
                   const Results& results, const Threads& threads) {
    std::vector<const Output*> asked;
    for (const Output& o : outputs()) {
        if (is_asked(formats, o.format)) {
            asked.push_back(&o);
        } else {
            std::error_code ignored;
            std::filesystem::remove(dir.file(o.file), ignored);
        }
    }
    // The picture, which takes longest, is the last one.
    threads.for_each(static_cast<std::int64_t>(asked.size()), 1,
                     [&](std::int64_t from, std::int64_t to) {
                         for (std::int64_t i = from; i < to; ++i) {
                             const Output& o = *asked[asked.size() - 1 - idx(i)];
                             o.write(dir.file(o.file), results);
                         }
                     });
}

// Which pieces the files list, where not all.
std::string pieces_text(const Config& config, const std::vector<PieceStatus>& pieces) {
    const auto count = static_cast<std::int64_t>(pieces.size());
    const auto& formats = config.output.formats;
    const bool listed = is_asked(formats, "csv") || is_asked(formats, "gpkg");
    if (lists_all(config.output.pieces, count) || !listed) return "";
    return fmt::format(
        "files        pieces.csv and plan.gpkg list the {} pieces that are not covered, of {} "
        "(output.pieces = \"all\" lists all)\n",
        count - std::count(pieces.begin(), pieces.end(), PieceStatus::covered), count);
}

// From tables to a plan and all files of it, published as one. `overrides`: what was set beyond the
// folder's job. `before_publishing`: writes what else belongs to the plan.
std::string plan_of(const RunDir& dir, const Config& config,
                    const std::vector<std::string>& overrides, const Threads& threads, bool alone,
                    Progress& progress, const std::function<void()>& before_publishing) {
    // Until files are written, a search or a proof may take long without a place to stop at. Of
    // several processes none may end by itself: there each window of a search is such a place.
    std::optional<SignalsEnd> at_once;
    if (alone) at_once.emplace();
    const Threads planning(threads.count(), stop_if_asked);
    progress.stage("read");
    const FieldFile field(dir.file(field_name));
    dir.check_job(field.info().key);
    const PlanOptions options = plan_options(config);
    const Candidates candidates = read_candidates(dir.path(), options.candidates);
    const CoverageTables& tables = candidates.tables;
    const CoverageEntries& entries = candidates.entries;
    // The rows are gone before files are written.
    const Planned planned = plan_stations(plan_tables_of(tables, entries, options.overlap.ratio),
                                          options, config.scanner.range_max_m, planning, progress);
    at_once.reset();
    progress.stage("files");
    withdraw_plan(dir.path());
    write_plan(dir.file(plan_name),
               {planned.plan, tables.key, options.overlap, options.candidates, options.survive});
    write_outputs(dir, config.output.formats,
                  {field, tables, planned.plan, config.site.input.filename().string(),
                   plan_line(planned), static_cast<int>(config.output.map_px),
                   lists_all(config.output.pieces, tables.pieces.size()),
                   [&](std::int64_t n, const std::function<void(std::int64_t)>& body) {
                       threads.for_each(n, 1, [&](std::int64_t from, std::int64_t to) {
                           for (std::int64_t i = from; i < to; ++i) body(i);
                       });
                   }},
                  threads);
    Json summary = summary_of_tables(field, tables);
    summary.update(summary_of_plan(planned, tables));
    summary["plan"]["method"] = name_of(options.method);
    summary["plan"]["loops"] = options.loops;
    if (!overrides.empty()) summary["plan"]["set"] = overrides;
    summary["kernel"] = name_of(config.visibility.kernel);
    summary["overlap"] = {{"ratio", name_of(config.overlap.ratio)},
                          {"threshold", config.overlap.threshold}};
    progress.stage("hash");
    summary["result_sha256"] = result_hash(field, tables, entries, planned.plan);
    progress.finish();
    add_times(summary, progress);
    if (before_publishing) before_publishing();
    publish_plan(dir.path(), std::move(summary));
    return plan_text(planned, tables, config) + pieces_text(config, planned.plan.pieces);
}

// For precompute: what there is before a plan.
std::string summary_before_plan(const RunDir& dir, const Config& config, Progress& progress) {
    progress.stage("read");
    const FieldFile field(dir.file(field_name));
    const CoverageTables tables = read_coverage(dir.file(coverage_name));
    Json summary = summary_of_tables(field, tables);
    summary["candidates"] = tables.candidates.size();
    summary["pieces"] = tables.pieces.size();
    summary["kernel"] = name_of(config.visibility.kernel);
    progress.finish();
    add_times(summary, progress);
    publish_plan(dir.path(), std::move(summary));
    return fmt::format("tables       {} candidates x {} pieces\n", tables.candidates.size(),
                       tables.pieces.size());
}

// Candidates were placed so that neighbours overlap enough by the rule of the tables; a plan by a
// rule that asks for more would fall apart where a run would have put more candidates.
void check_overlap(const Config& tables, const Config& plan, const std::filesystem::path& dir) {
    const auto rule = [](const Config& c) { return plan_options(c).overlap; };
    const double most = implied_threshold(rule(tables), rule(plan).ratio);
    if (rule(plan).enough(most)) return;
    throw UsageError(fmt::format(
        "overlap {} {}: the candidates of {} were placed for {} {}, so that a plan could fall "
        "apart where there would be more of them; {}, or use run with this overlap and another "
        "--out",
        name_of(rule(plan).ratio), rule(plan).threshold, dir.string(), name_of(rule(tables).ratio),
        rule(tables).threshold,
        most > 0 ? fmt::format("plan takes {} up to {:.3f} here", name_of(rule(plan).ratio),
                               std::floor(most * 1000) / 1000)
                 : fmt::format("plan takes other ratios here, not {}", name_of(rule(plan).ratio))));
}

bool has_begun(const RunDir& dir, bool fresh) {
    std::error_code ignored;
    return !fresh && (std::filesystem::exists(site_store_path(dir.path()), ignored) ||
                      std::filesystem::exists(dir.file(coverage_name), ignored));
}

}  // namespace

std::string run_job(const Config& config, const JobOptions& options, const Ranks& ranks,
                    Progress& progress) {
    const Threads threads(options.threads);
    const RunDir dir(options.out);
    progress.stage("site");
    const InputState input(config);
    const JobKeys keys = job_keys(config, input.sha256());
    std::string text;
    if (options.dry_run) {
        ranks.lead([&] {
            const Estimate found = estimate(config, options, progress);
            check_estimate(found, options, threads);
            warn_of_shortage(found, options.out, progress);
            text = estimate_text(found, config, threads);
        });
        return text;
    }
    if (options.memory_bytes > 0 || options.time_s > 0) {
        ranks.lead([&] {
            if (has_begun(dir, options.fresh)) return;  // it was let through then
            Progress quiet(true, true);
            check_estimate(estimate(config, options, quiet), options, threads);
        });
    }
    run_in_folder(
        dir, config, keys, options.fresh, ranks,
        [&] {
            tables_of(dir, config, keys, input, options.plan, threads, ranks, progress);
            add_pool(dir, config, threads, ranks, progress);
        },
        [&] {
            ranks.lead([&] {
                dir.remove_work();
                const auto tell = [&] {
                    write_text(dir.file(provenance_name),
                               provenance(config, input.sha256(), threads.count(), ranks.count()));
                };
                tell();  // a plan that is stopped leaves tables that others may plan from
                text = options.plan
                           ? plan_of(dir, config, {}, threads, ranks.count() == 1, progress, tell)
                           : summary_before_plan(dir, config, progress);
            });
        });
    if (!ranks.leader()) return "";
    return text +
           fmt::format("written to   {} in {:.1f} s\n", dir.path().string(), progress.wall_s());
}

std::string plan_again(const std::filesystem::path& path, const std::filesystem::path& out,
                       const std::vector<std::string>& overrides, int thread_count,
                       Progress& progress) {
    Config any;
    std::vector<std::string> kept;  // of what goes into the job file of a copy
    for (const std::string& s : overrides) {
        const std::string key = s.substr(0, s.find('='));
        for (const Parameter& p : parameters(any)) {
            if (p.key() != key) continue;
            if (p.section != "overlap") kept.push_back(s);
            if (p.section == "overlap" || p.section == "output") continue;
            if (p.stale == Stale::plan) continue;
            throw UsageError(
                fmt::format("--set {}: plan works from finished tables, and {} belongs to "
                            "those; use run with another --out",
                            s, key));
        }
    }
    const Threads threads(thread_count);
    const RunDir from(path);
    const Config config = from.config(overrides);
    from.check_ours();
    refuse_links(path);
    check_overlap(from.config(), config, path);
    const RunDir dir(out.empty() ? path : out);
    std::optional<FolderLock> source;
    if (!out.empty()) {
        std::error_code ignored;
        if (std::filesystem::equivalent(out, path, ignored)) {
            throw UsageError(fmt::format(
                "--out {}: is the folder itself; leave --out away to plan in it", out.string()));
        }
        source.emplace(path, FolderLock::Hold::copy);
        from.provenance();
        std::filesystem::create_directories(out, ignored);
    }
    if (!dir.holds_nothing()) dir.check_ours();
    const FolderLock lock(dir.path(), FolderLock::Hold::lead);
    if (!out.empty()) dir.begin_copy(from, kept);
    add_pool(dir, config, threads, Ranks{Ranks::Alone{}}, progress);
    dir.remove_work();
    return plan_of(dir, config, overrides, threads, true, progress, {});
}

}  // namespace vfplan
