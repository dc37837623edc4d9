#include "engine/cli/cli.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <sstream>
#include <string_view>

#include "engine/cli/submit.h"
#include "engine/compare/compare.h"
#include "engine/compare/sweep.h"
#include "engine/config/parameters.h"
#include "engine/generate/generate.h"
#include "engine/job/inspect.h"
#include "engine/job/pipeline.h"
#include "engine/job/verify.h"
#include "engine/runtime/ending.h"
#include "engine/runtime/launch.h"
#include "engine/runtime/memory.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/ranks.h"
#include "engine/runtime/stop.h"
#include "io/files.h"
#include "kernels/error.h"
#include "kernels/isa.h"
#include "kernels/printable.h"
#include "vfplan_version.h"

namespace vfplan {
namespace {

constexpr const char* run_help =
    R"(Plans static-LiDAR stations for a site. Your own GeoJSON in five minutes:

  1. Write job.toml:        preset = "outdoor"        # or "indoor"
                            [site]
                            input = "my_town.geojson" # metres; polygons are buildings
                            [field]
                            cell_m = 2                # indoor: 0.05
  2. vfplan run job.toml --out my_town
  3. Look at my_town/map.png; stations are in my_town/stations.csv.

Longitudes and latitudes: add crs = "utm" under [site]. How long a large site will take: --dry-run.
All parameters: docs/parameters.md or vfplan parameters; any of them: --set scanner.range_max_m=40)";

constexpr const char* exit_codes =
    "Exit codes: 0 done; 1 verify said no; 2 usage or configuration; 3 input data; 4 reading or "
    "writing; 70 a fault of the program; 75 stopped early, resumable.\n"
    "VFPLAN_ISA=sse2|sse4.2|avx|avx2|avx512 holds the kernels to an instruction set.";

// Options that several commands share.
struct Shared {
    std::string job;
    std::string dir;
    std::string out;
    std::vector<std::string> sets;
    std::vector<std::string> dirs;
    std::string csv;
    int threads = 0;
    bool quiet = false;
    bool fresh = false;
    bool dry_run = false;
    double memory_bytes = 0;
    double time_s = 0;
};

void add_sets(CLI::App& app, Shared& s, const char* which) {
    app.add_option("--set", s.sets, which)->type_name("KEY=VALUE")->take_all()->expected(1);
}

void add_common(CLI::App& app, Shared& s) {
    app.add_option("--threads", s.threads, "Threads; default: what the machine grants")
        ->check(CLI::Range(1, 4096));
    app.add_flag("-q,--quiet", s.quiet, "No progress, no summary");
}

void add_memory(CLI::App& app, Shared& s) {
    app.add_option("--memory", s.memory_bytes,
                   "Most memory of each process: 500M, 2G. It works on less at once to keep within "
                   "it, and ends with words where it cannot; default: what there is")
        ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{
            {"k", 0x1p10}, {"m", 0x1p20}, {"g", 0x1p30}, {"t", 0x1p40}}))
        ->check([](const std::string& bytes) -> std::string {
            return std::stod(bytes) < 0x1p26 ? "at least 64M, which the program alone takes" : "";
        })
        ->type_name("SIZE");
}

void hold_to_memory(const Shared& s) {
    if (s.memory_bytes > 0) limit_memory(s.memory_bytes, Threads(s.threads).count());
}

void add_job_and_out(CLI::App& app, Shared& s) {
    app.add_option(
           "JOB", s.job,
           "Job file (.toml; configs/ has examples), or a site to plan with the preset that fits")
        ->required();
    app.add_option("--out", s.out, "Run directory; default: the job file's name without .toml");
    add_sets(app, s, "Replaces a parameter of the job file; may be repeated");
}

void add_job(CLI::App& app, Shared& s) {
    add_job_and_out(app, s);
    app.add_flag("--fresh", s.fresh, "Make everything again; default: go on where a run stopped");
    app.add_flag("--dry-run", s.dry_run,
                 "Check the job and the site, print cells, memory, disk and time");
    add_memory(app, s);
    app.add_option("--time", s.time_s,
                   "Refuse a job that takes longer, by the estimate of --dry-run: 90s, 10m, 2h")
        ->transform(CLI::AsNumberWithUnit(
            std::map<std::string, double>{{"s", 1}, {"m", 60}, {"min", 60}, {"h", 3600}}))
        ->type_name("TIME");
    add_common(app, s);
}

[[noreturn]] void fail_to_write(int error) {
    throw IoError(fmt::format("standard output cannot be written: {}; {}", std::strerror(error),
                              advice_on(error)));
}

// To standard output: a text for other programs, byte by byte.
void put(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) fail_to_write(errno);
}

// The same for people.
void say(const std::string& text) { put(printable(text)); }

// What is still in buffers would be lost in silence at the end of the process.
void flush_output() {
    errno = 0;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        fail_to_write(errno != 0 ? errno : EIO);
}

std::filesystem::path out_of(const Shared& s) {
    if (!s.out.empty()) return s.out;
    std::filesystem::path out = std::filesystem::path(s.job).stem();
    if (out.extension().empty() && std::filesystem::path(s.job) == out) out += ".run";
    return out;
}

bool is_job_file(const Shared& s) { return std::filesystem::path(s.job).extension() == ".toml"; }

// A job file, or a site that is planned with the preset that fits. Nothing is written, so a signal
// may end it at once.
BareSite job_or_site(const Shared& s) {
    if (is_job_file(s)) return {read_config(s.job, s.sets), {}};
    const SignalsEnd at_once;
    return bare_site(s.job, s.sets);
}

int run_or_precompute(const Shared& s, bool plan, const Ranks& ranks) {
    Progress progress(s.quiet, !ranks.leader());
    const Config config = job_or_site(s).config;
    if (ranks.leader() && !is_job_file(s)) {
        progress.note(fmt::format("{} is a site, no job file: planned with preset \"{}\"", s.job,
                                  name_of(config.preset)));
    }
    JobOptions options;
    options.out = out_of(s);
    options.threads = s.threads;
    options.fresh = s.fresh;
    options.dry_run = s.dry_run;
    options.plan = plan;
    options.memory_bytes = s.memory_bytes;
    options.time_s = s.time_s;
    hold_to_memory(s);
    if (const std::string warning = binding_warning(); !warning.empty()) {
        progress.warn(warning);
    }
    const std::string text = run_job(config, options, ranks, progress);
    if (!s.quiet && ranks.leader()) say(text);
    return 0;
}

int generate(const GenerateOptions& options, const std::string& out) {
    const GenerateReport report = generate_site(options);
    if (out.empty() || out == "-") {
        put(report.geojson);
        fmt::print(stderr, "{}", report.summary);
        return 0;
    }
    const std::filesystem::path file(out);
    if (file.has_parent_path()) {
        std::error_code error;
        std::filesystem::create_directories(file.parent_path(), error);
    }
    write_text(file, report.geojson);
    say(report.summary);
    return 0;
}

void add_submit(CLI::App& app, Shared& s, SubmitOptions& o, bool& print) {
    add_job_and_out(app, s);
    app.add_option("--nodes", o.nodes, "Machines")->check(CLI::Range(1, 100000));
    app.add_option("--ranks-per-node", o.ranks_per_node,
                   "Processes on each; default: one per socket that Slurm knows of")
        ->check(CLI::Range(1, 1024));
    app.add_option("--threads", s.threads,
                   "Threads of each process; default: all processors of nodes that are taken whole")
        ->check(CLI::Range(1, 4096));
    app.add_option("--time", o.time, "Time limit as Slurm writes it: 30, 12:00:00, 2-0");
    app.add_option("--account", o.account, "Slurm account");
    app.add_option("--partition", o.partition, "Slurm partition");
    app.add_flag("--print", print, "Print the batch script, submit nothing");
}

int submit_job(const Shared& s, SubmitOptions o, bool print) {
    o.job = s.job;
    o.out = out_of(s);
    o.sets = s.sets;
    o.threads = s.threads;
    o.program = std::filesystem::read_symlink("/proc/self/exe");
    o.folder = std::filesystem::current_path();
    put(submit(o, print));
    return 0;
}

int verify(const Shared& s) {
    Progress progress(true);
    const VerifyResult r = verify_run(s.dir, s.threads, progress);
    if (!s.quiet) say(r.text);
    say(r.good ? "yes: the plan holds\n" : "NO: the plan does not hold\n");
    return r.good ? 0 : 1;
}

int compare_plans(const Shared& s) {
    if (s.dirs.size() < 2) {
        throw UsageError("compare sets plans side by side: name two run directories or more");
    }
    const Comparison c = compare({s.dirs.begin(), s.dirs.end()});
    if (!s.csv.empty()) write_text(s.csv, csv_of(c));
    if (!s.out.empty()) write_text(s.out, picture_of(c));
    if (!s.quiet) say(text_of(c, true));
    return 0;
}

int sweep_job(const Shared& s, const Ranks& ranks) {
    if (!is_job_file(s)) {
        throw UsageError(fmt::format("{}: sweep takes a job file (.toml)", s.job));
    }
    std::filesystem::path out = s.out;
    if (out.empty()) out = std::filesystem::path(s.job).stem().string() + ".sweep";
    const Comparison c = sweep(s.job, s.sets, out, s.threads, ranks, s.quiet);
    if (!s.quiet && ranks.leader()) {
        say(fmt::format("{}table      {}\npicture    {}\n", text_of(c, false),
                        (out / "sweep.csv").string(), (out / "sweep.png").string()));
    }
    return 0;
}

int look_at_site(const Shared& s) {
    const std::filesystem::path picture =
        s.out.empty() ? std::filesystem::path(s.job).stem().string() + ".site.png" : s.out;
    const auto look = [&] {
        BareSite site = job_or_site(s);
        const SignalsEnd at_once;  // nothing is written yet
        return inspect(site.config, s.threads, std::move(site.features));
    };
    const Inspection found = look();
    write_text(picture, found.picture);
    say(fmt::format("{}picture    {}\n", found.text, picture.string()));
    return 0;
}

int dispatch(int argc, char** argv, const Ranks& ranks) {
    if (const char* isa = std::getenv("VFPLAN_ISA"); isa != nullptr && *isa != '\0') {
        limit_isa(isa);
    }
    CLI::App app{
        "Plans connected networks of static-LiDAR stations from city maps and floor "
        "plans.",
        "vfplan"};
    app.require_subcommand(1);
    app.set_version_flag("--version", fmt::format("vfplan {} ({}, {}, {})", version, version_git,
                                                  build_type, Ranks::built_with()));
    app.footer(exit_codes);
    Shared s;
    GenerateOptions site;
    std::string site_out;

    const bool about_run = argc > 1 && std::string_view(argv[1]) == "run";
    CLI::App* run = app.add_subcommand(
        "run", about_run ? run_help : "The whole job: site to stations; start with run --help");
    add_job(*run, s);
    run->footer(exit_codes);
    CLI::App* precompute = app.add_subcommand(
        "precompute", "Field and coverage tables only; plan DIR or run goes on from there");
    add_job(*precompute, s);
    CLI::App* plan = app.add_subcommand(
        "plan", "Plans again from a run directory's tables alone, without geometry");
    plan->add_option("DIR", s.dir, "Run directory")->required();
    plan->add_option("--out", s.out,
                     "Puts the plan into a folder of its own, with the tables; DIR stays as it is");
    add_sets(*plan, s,
             "Replaces plan.* but points and areas, overlap.* (no higher threshold) or output.*");
    add_memory(*plan, s);
    add_common(*plan, s);
    CLI::App* check = app.add_subcommand(
        "verify", "Looks again from every station with the exact kernel; says yes or no");
    check->add_option("DIR", s.dir, "Run directory")->required();
    add_common(*check, s);
    CLI::App* beside = app.add_subcommand("compare", "Plans side by side: one table, one picture");
    beside->add_option("DIR", s.dirs, "Run directories, two or more")->required();
    beside->add_option("--out", s.out, "Also a picture (PNG)");
    beside->add_option("--csv", s.csv, "Also the table with every figure in full (CSV)");
    beside->add_flag("-q,--quiet", s.quiet, "No table");
    CLI::App* sweeping = app.add_subcommand(
        "sweep", "Plans a job with several values of parameters, and compares the plans");
    sweeping->add_option("JOB", s.job, "Job file (.toml)")->required();
    sweeping->add_option("--out", s.out,
                         "Folder for a run directory each, sweep.csv and sweep.png; default: the "
                         "job file's name with .sweep");
    add_sets(*sweeping, s,
             "KEY=VALUE,VALUE,...; may be repeated: every combination, each in a folder of its "
             "own. With one value it goes for all");
    add_common(*sweeping, s);
    CLI::App* look = app.add_subcommand(
        "inspect", "Says what a site was read as: roles, units, walls, ground; and draws it");
    look->add_option("FILE", s.job, "Site file, or job file (.toml)")->required();
    look->add_option("--out", s.out, "The picture; default: the file's name with .site.png");
    add_sets(*look, s, "A parameter, as for run; may be repeated");
    add_common(*look, s);
    CLI::App* make = app.add_subcommand("generate", "Writes a synthetic site as GeoJSON");
    make->add_option("KIND", site.kind, "town | city | flat")->required();
    make->add_option("--seed", site.seed, "Another seed, another site")->capture_default_str();
    make->add_option("--size-km", site.size_km, "city: side of the square")->capture_default_str();
    make->add_option("--rooms", site.rooms, "flat: number of rooms")->capture_default_str();
    make->add_option("--out", site_out, "GeoJSON file; default: standard output");
    SubmitOptions slurm;
    bool print = false;
    CLI::App* queue = app.add_subcommand(
        "submit",
        "Hands the job to Slurm, on one machine or several; takes it up after preemption");
    add_submit(*queue, s, slurm, print);
    queue->footer(exit_codes);
    CLI::App* list = app.add_subcommand("parameters", "Prints all parameters as Markdown");

    if (argc > 1 && argv[1][0] != '-' &&
        app.get_subcommands([&](CLI::App* a) { return a->get_name() == argv[1]; }).empty()) {
        throw UsageError(fmt::format("{}: no such command; see vfplan --help", argv[1]));
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& e) {
        if (!ranks.leader()) return 0;
        std::ostringstream text;  // --help, --version
        const int code = app.exit(e, text, text);
        put(text.str());
        return code;
    } catch (const CLI::ParseError& e) {
        throw UsageError(fmt::format("{}; see vfplan --help", e.what()));
    }
    if (run->parsed()) return run_or_precompute(s, true, ranks);
    if (precompute->parsed()) return run_or_precompute(s, false, ranks);
    if (sweeping->parsed()) return sweep_job(s, ranks);
    if (!ranks.leader()) return 0;  // the other commands are for one process
    if (check->parsed()) return verify(s);
    if (beside->parsed()) return compare_plans(s);
    if (look->parsed()) return look_at_site(s);
    if (make->parsed()) {
        for (const auto& [option, kind] : {std::pair("--rooms", "flat"), {"--size-km", "city"}}) {
            if (make->count(option) > 0 && site.kind != kind) {
                throw UsageError(
                    fmt::format("{} is for generate {} only; leave it out", option, kind));
            }
        }
        return generate(site, site_out);
    }
    if (queue->parsed()) return submit_job(s, slurm, print);
    if (list->parsed()) {
        put(parameters_markdown());
        return 0;
    }
    hold_to_memory(s);
    Progress progress(s.quiet);
    const std::string text = plan_again(s.dir, s.out, s.sets, s.threads, progress);
    if (!s.quiet) say(text);
    return 0;
}

}  // namespace

int run_cli(int argc, char** argv) {
    watch_signals();
    return run_to_end([&](const Ranks& ranks) {
        const int code = dispatch(argc, argv, ranks);
        flush_output();
        return code;
    });
}

}  // namespace vfplan
