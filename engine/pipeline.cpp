#include "engine/pipeline.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>
#include <optional>

#include "engine/estimate.h"
#include "engine/plan_stage.h"
#include "engine/tables_stage.h"
#include "io/files.h"
#include "io/sha256.h"
#include "kernels/error.h"
#include "vfplan_version.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

std::string input_hash(const Config& config) {
    std::error_code error;
    for (const std::string* path : {&config.site.input, &config.plan.forbidden}) {
        if (path->empty() || std::filesystem::exists(*path, error)) continue;
        throw IoError(
            fmt::format("{}: no such file; check {} in the job file, it is relative to it", *path,
                        path == &config.site.input ? "site.input" : "plan.forbidden"));
    }
    std::string hash;
    if (std::filesystem::is_regular_file(config.site.input)) {
        hash = sha256_of_file(config.site.input);
    }
    if (!config.plan.forbidden.empty()) hash += sha256_of_file(config.plan.forbidden);
    return hash;
}

void add_times(Json& j, const Progress& progress) {
    Json wall = Json::object();
    Json cpu = Json::object();
    Json peak = Json::object();
    for (const StageTime& s : progress.times()) {
        wall[s.name] = wall.value(s.name, 0.0) + s.wall_s;
        cpu[s.name] = cpu.value(s.name, 0.0) + s.cpu_s;
        peak[s.name] = std::max(peak.value(s.name, 0.0), s.peak_rss_mb);
    }
    j["stage_wall_s"] = wall;
    j["stage_cpu_s"] = cpu;
    j["stage_peak_rss_mb"] = peak;
    j["wall_s"] = progress.wall_s();
    j["peak_rss_mb"] = progress.peak_rss_mb();
}

void write_provenance(const RunDir& dir, const Config& config, const std::string& input_sha256,
                      int threads, int ranks) {
    char host[256] = {};
    gethostname(host, sizeof host - 1);
    const std::time_t now = std::time(nullptr);
    char when[32] = {};
    std::strftime(when, sizeof when, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    const Json j = {{"program", "vfplan"},
                    {"version", version},
                    {"version_git", version_git},
                    {"build_type", build_type},
                    {"input", config.site.input},
                    {"input_sha256", input_sha256},
                    {"host", host},
                    {"threads", threads},
                    {"ranks", ranks},
                    {"finished_utc", when}};
    write_text(dir.file("provenance.json"), j.dump(2) + "\n");
}

// What the tables know of how they were made.
Json table_summary(const FieldFile& field, const CoverageTables& coverage) {
    Json j = Json::parse(coverage.summary);
    j.update(Json::parse(field.info().summary));
    return j;
}

// Plans, writes everything that depends on the plan, and summary.json last of all.
std::string finish_plan(const RunDir& dir, const Config& config, const Threads& threads,
                        Progress& progress) {
    progress.stage("read");
    const FieldFile field(dir.file("field.h5"));
    const CoverageTables tables = read_coverage(dir.file("coverage.h5"));
    const CoverageEntries entries(dir.file("coverage.h5"));
    const PlanOptions options = plan_options(config);
    Planned planned;
    {
        const PlanTables input = plan_tables_of(tables, entries, options.ratio);
        planned = plan_tables(options, config.scanner.range_max_m, input, threads, progress);
    }
    progress.stage("files");
    write_plan_files(dir, config, field, tables, planned);
    Json summary = table_summary(field, tables);
    summary.update(summary_of(planned, tables));
    summary["kernel"] = config.visibility.kernel;
    summary["overlap"] = {{"ratio", config.overlap.ratio}, {"threshold", config.overlap.threshold}};
    progress.stage("hash");
    summary["result_sha256"] = result_hash(field, tables, entries, planned.plan);
    progress.finish();
    add_times(summary, progress);
    write_text(dir.file("summary.json"), summary.dump(2) + "\n");
    return plan_text(planned, tables, config);
}

// For precompute: what there is before a plan.
std::string finish_tables(const RunDir& dir, const Config& config, Progress& progress) {
    progress.stage("read");
    const FieldFile field(dir.file("field.h5"));
    const CoverageTables tables = read_coverage(dir.file("coverage.h5"));
    Json summary = table_summary(field, tables);
    summary["candidates"] = tables.candidates.size();
    summary["pieces"] = tables.pieces.size();
    summary["kernel"] = config.visibility.kernel;
    progress.finish();
    add_times(summary, progress);
    write_text(dir.file("summary.json"), summary.dump(2) + "\n");
    return fmt::format("tables       {} candidates x {} pieces\n", tables.candidates.size(),
                       tables.pieces.size());
}

}  // namespace

std::string run_job(const Config& config, const JobOptions& options, const Ranks& ranks,
                    Progress& progress) {
    const Threads threads(options.threads);
    const RunDir dir(options.out);
    progress.stage("site");
    const std::string input_sha256 = input_hash(config);
    const JobKeys keys = job_keys(config, input_sha256);
    if (options.dry_run) {
        std::string text;
        ranks.lead(
            [&] { text = estimate_text(estimate(config, threads, progress), config, threads); });
        return text;
    }
    std::optional<FolderLock> lock;      // the other ranks'
    std::optional<ClaimedFolder> claim;  // the leader's
    try {
        ranks.lead([&] {
            claim.emplace(dir, config, keys, options.fresh);
            if (!tables_complete(dir.path(), keys.tables, progress)) {
                dir.remove_plan();
                make_site(config, dir.path(), keys.tables, threads, progress);
            }
        });
        if (!ranks.leader()) lock.emplace(dir, false);
        if (!std::filesystem::exists(dir.file("field.h5")) ||
            !std::filesystem::exists(dir.file("coverage.h5"))) {
            make_tables(config, dir.path(), keys.tables, threads, ranks, progress);
        } else {
            progress.note(
                "tables       of this job are complete in the folder and used as they are");
        }
    } catch (const Error& e) {
        // A job that cannot be done as it stands leaves nothing; of all others, shards stay.
        if (claim && e.code() != Exit::usage && e.code() != Exit::input) claim->keep();
        throw;
    } catch (...) {  // out of memory, say
        if (claim) claim->keep();
        throw;
    }
    if (claim) claim->keep();
    std::string text;
    ranks.lead([&] {
        dir.remove_work();
        text = options.plan ? finish_plan(dir, config, threads, progress)
                            : finish_tables(dir, config, progress);
        write_provenance(dir, config, input_sha256, threads.count(), ranks.count());
    });
    if (!ranks.leader()) return "";
    return text +
           fmt::format("written to   {} in {:.1f} s\n", dir.path().string(), progress.wall_s());
}

std::string plan_again(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                       int thread_count, Progress& progress) {
    Config any;
    for (const std::string& s : overrides) {
        const std::string key = s.substr(0, s.find('='));
        for (const auto& entry : parameters(any)) {
            const Parameter& p = entry.first;
            if (p.key() != key || p.stage != Stage::tables || p.section == "overlap") continue;
            throw UsageError(
                fmt::format("--set {}: plan works from finished tables, and {} changes "
                            "those; use run with another --out",
                            s, key));
        }
    }
    const Threads threads(thread_count);
    const RunDir dir(path);
    const Config config = dir.config(overrides);
    const FolderLock lock(dir, true);
    return finish_plan(dir, config, threads, progress);
}

}  // namespace vfplan
