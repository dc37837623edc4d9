#include "engine/pipeline.h"

#include <fmt/format.h>
#include <unistd.h>

#include <ctime>

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

Json site_summary(const Site& site) {
    return {{"buildings", site.buildings},
            {"walls", site.walls.size()},
            {"area_m2", site.area_m2},
            {"width_m", site.extent.size().x()},
            {"height_m", site.extent.size().y()},
            {"cleaning",
             {{"features", site.counts.features},
              {"ignored", site.counts.ignored},
              {"outside_crop", site.counts.outside_crop},
              {"repaired", site.counts.repaired},
              {"dropped_invalid", site.counts.dropped_invalid},
              {"edges_in", site.counts.edges_in},
              {"zero_length", site.counts.zero_length},
              {"duplicates", site.counts.duplicates},
              {"split", site.counts.split},
              {"merged", site.counts.merged},
              {"inside_solids", site.counts.inside_solids}}}};
}

std::string site_text(const Site& site) {
    const CleaningCounts& c = site.counts;
    return fmt::format(
        "site         {} features, {} walls on {:.0f} x {:.0f} m (edges: {} read, {} too short, {} "
        "repeated, {} split, {} joined, {} inside solids)",
        c.features, site.walls.size(), site.extent.size().x(), site.extent.size().y(), c.edges_in,
        c.zero_length, c.duplicates, c.split, c.merged, c.inside_solids);
}

std::string estimate_text(const Config& config, const Prepared& p, const Threads& threads) {
    const Estimate e = estimate(config, p, threads);
    return fmt::format(
        "cells        {} of {} m, {} of them free\n"
        "pieces       {}\n"
        "candidates   about {}\n"
        "memory       about {:.0f} MB\n"
        "disk         about {:.1f} MB\n"
        "field        about {:.2g} s with {} threads\n"
        "The job is valid; nothing was written.\n",
        e.cells, config.field.cell_m, e.free_cells, e.pieces, e.candidates, e.memory_mb, e.disk_mb,
        e.field_s, threads.count());
}

void add_times(Json& j, const Progress& progress) {
    Json wall = Json::object();
    Json cpu = Json::object();
    for (const StageTime& s : progress.times()) {
        wall[s.name] = wall.value(s.name, 0.0) + s.wall_s;
        cpu[s.name] = cpu.value(s.name, 0.0) + s.cpu_s;
    }
    j["stage_wall_s"] = wall;
    j["stage_cpu_s"] = cpu;
    j["wall_s"] = progress.wall_s();
    j["peak_rss_mb"] = peak_rss_mb();
}

void write_provenance(const RunDir& dir, const Config& config, const std::string& input_sha256,
                      int threads) {
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
                    {"finished_utc", when}};
    write_text(dir.file("provenance.json"), j.dump(2) + "\n");
}

// What the field cost in operations. For the rays "steps" are rays.
Json field_summary(const Config& config, const FieldCounts& c) {
    Json j = {{"kernel", config.visibility.kernel}, {"cells", c.cells}, {"packets", c.packets}};
    const double cells = static_cast<double>(std::max<std::int64_t>(1, c.cells));
    if (config.visibility.kernel == "embree") {
        j["rays"] = c.steps;
        j["rays_per_view"] = static_cast<double>(c.steps) / cells;
    } else {
        j["steps"] = c.steps;
        j["walls_met"] = c.walls;
    }
    return j;
}

Json candidate_summary(const CandidateReport& r) {
    return {{"joints", r.joints},
            {"ridges", r.ridges},
            {"ridges_short_of_overlap", r.ridges_short_of_overlap},
            {"rescued_pieces", r.rescued_pieces},
            {"parts_before_links", r.parts_before_links},
            {"parts", r.parts}};
}

Json read_summary(const RunDir& dir) {
    if (!std::filesystem::exists(dir.file("summary.json"))) return Json::object();
    try {
        return Json::parse(read_text(dir.file("summary.json")));
    } catch (const Json::parse_error& e) {
        throw IoError(fmt::format("{}: damaged ({}); run the job again with --fresh",
                                  dir.file("summary.json").string(), e.what()));
    }
}

// Plans, writes everything that depends on the plan, and summary.json last of all.
std::string finish_plan(const RunDir& dir, const Config& config, const FieldTable& field,
                        const CoverageTables& tables, Json summary, const Threads& threads,
                        Progress& progress) {
    const Planned planned = plan_tables(config, tables, threads, progress);
    progress.stage("files");
    write_plan_files(dir, config, field, tables, planned);
    summary.update(summary_of(planned, tables));
    summary["kernel"] = config.visibility.kernel;
    summary["overlap"] = {{"ratio", config.overlap.ratio}, {"threshold", config.overlap.threshold}};
    progress.finish();
    add_times(summary, progress);
    summary["result_sha256"] = result_hash(field, tables, planned.plan);
    write_text(dir.file("summary.json"), summary.dump(2) + "\n");
    return plan_text(planned, tables, config);
}

}  // namespace

std::string run_job(const Config& config, const JobOptions& options, Progress& progress) {
    const Threads threads(options.threads);
    const RunDir dir(options.out);
    progress.stage("site");
    const std::string input_sha256 = input_hash(config);
    const JobKeys keys = job_keys(config, input_sha256);
    if (!options.dry_run) dir.check(keys, options.fresh);

    const bool have_tables = !options.fresh && !options.dry_run &&
                             key_of(dir.file("field.h5")) == keys.tables &&
                             key_of(dir.file("coverage.h5")) == keys.tables &&
                             std::filesystem::exists(dir.file("summary.json"));
    Tables tables;
    Json summary;
    if (have_tables) {
        progress.note("tables       of this job are complete in the folder and used as they are");
        tables.field = read_field(dir.file("field.h5"));
        tables.coverage = read_coverage(dir.file("coverage.h5"));
        summary = read_summary(dir);
    } else {
        SiteResult read = read_site(config.site.input, site_options(config));
        for (const std::string& w : read.warnings) progress.note("warning: " + w);
        const Prepared prepared = prepare(config, std::move(read.site));
        progress.note(site_text(prepared.site));
        if (options.dry_run) {
            progress.finish();
            return estimate_text(config, prepared, threads);
        }
        ClaimedFolder folder(dir.path());
        tables = make_tables(config, prepared, keys.tables, threads, progress);
        progress.stage("tables");
        // From here on the folder is this job's; what an older run left must not stand beside it.
        std::error_code ignored;
        for (const char* old : {"summary.json", "plan.h5"}) {
            std::filesystem::remove(dir.file(old), ignored);
        }
        dir.write_job(config, keys);
        folder.keep();
        write_field(dir.file("field.h5"), tables.field);
        write_coverage(dir.file("coverage.h5"), tables.coverage);
        summary["site"] = site_summary(prepared.site);
        summary["grid"] = {
            {"cells", prepared.grid.size()},
            {"free_cells", std::count(prepared.standable.begin(), prepared.standable.end(), 1)},
            {"cell_m", prepared.grid.cell_m}};
        summary["field_work"] = field_summary(config, tables.counts);
        summary["candidate_search"] = candidate_summary(tables.report);
    }
    std::string text;
    if (options.plan) {
        text = finish_plan(dir, config, tables.field, tables.coverage, std::move(summary), threads,
                           progress);
    } else {
        progress.finish();
        summary["candidates"] = tables.coverage.candidates.size();
        summary["pieces"] = tables.coverage.pieces.size();
        summary["kernel"] = config.visibility.kernel;
        add_times(summary, progress);
        write_text(dir.file("summary.json"), summary.dump(2) + "\n");
        text = fmt::format("tables       {} candidates x {} pieces\n",
                           tables.coverage.candidates.size(), tables.coverage.pieces.size());
    }
    write_provenance(dir, config, input_sha256, threads.count());
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
    progress.stage("read");
    const FieldTable field = read_field(dir.file("field.h5"));
    const CoverageTables tables = read_coverage(dir.file("coverage.h5"));
    return finish_plan(dir, config, field, tables, read_summary(dir), threads, progress);
}

}  // namespace vfplan
