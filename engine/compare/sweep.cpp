#include "engine/compare/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "engine/config/parameters.h"
#include "engine/folder/run_dir.h"
#include "engine/job/pipeline.h"
#include "engine/runtime/progress.h"
#include "io/files.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t runs_most = 1000;

// At commas outside of brackets, braces and quotes.
std::vector<std::string> parts_of(std::string_view text) {
    std::vector<std::string> out(1);
    int depth = 0;
    char quote = 0;
    for (const char c : text) {
        if (quote != 0) {
            if (c == quote) quote = 0;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '[' || c == '{') {
            ++depth;
        } else if (c == ']' || c == '}') {
            --depth;
        } else if (c == ',' && depth == 0) {
            out.emplace_back();
            continue;
        }
        out.back() += c;
    }
    return out;
}

// As a folder may be called.
std::string file_name(const std::string& text) {
    std::string out;
    for (const char c : text) {
        const bool plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                           (c >= 'A' && c <= 'Z') || c == '.' || c == '-' || c == '_' || c == '=';
        if (plain) {
            out += c;
        } else if (out.empty() || out.back() != '_') {
            out += '_';
        }
    }
    return out;
}

bool makes_tables_stale(const std::string& set) {
    Config any;
    const std::string key = set.substr(0, set.find('='));
    for (const Parameter& p : parameters(any)) {
        if (p.key() == key) return p.stale == Stale::tables;
    }
    return true;
}

}  // namespace

std::vector<SweepRun> sweep_runs(const std::vector<std::string>& sets) {
    std::vector<SweepRun> runs(1);
    for (const std::string& set : sets) {
        const std::size_t equals = set.find('=');
        if (equals == std::string::npos) {
            throw UsageError(fmt::format("--set {}: has no value; write --set key=value", set));
        }
        const std::string key = set.substr(0, equals);
        const std::vector<std::string> values = parts_of(std::string_view(set).substr(equals + 1));
        if (values.size() > 1 && std::count(values.begin(), values.end(), "") > 0) {
            throw UsageError(
                fmt::format("--set {}: a value between commas is empty; leave the comma out", set));
        }
        if (values.size() > runs_most / runs.size()) {
            throw UsageError(
                fmt::format("more than {} plans; sweep fewer values at a time", runs_most));
        }
        std::vector<SweepRun> more;
        for (const SweepRun& run : runs) {
            for (const std::string& value : values) {
                SweepRun next = run;
                const std::string one = fmt::format("{}={}", key, value);
                next.all.push_back(one);
                if (values.size() > 1) {
                    next.swept.push_back(one);
                    if (!next.name.empty()) next.name += ',';
                    next.name += file_name(one);
                }
                more.push_back(std::move(next));
            }
        }
        runs = std::move(more);
    }
    if (runs.size() < 2) {
        throw UsageError(
            "there is nothing to sweep: give a parameter several values, as in --set "
            "overlap.threshold=0.3,0.4,0.5");
    }
    std::map<std::string, int> times;
    for (SweepRun& run : runs) {
        const int n = ++times[run.name];
        if (n > 1) run.name += fmt::format("-{}", n);
    }
    return runs;
}

Comparison sweep(const fs::path& job, const std::vector<std::string>& sets, const fs::path& out,
                 int threads, const Ranks& ranks, bool quiet) {
    const std::vector<SweepRun> runs = sweep_runs(sets);
    // A value that is wrong is said before the first hour of work.
    for (const SweepRun& run : runs) read_config(job, run.all);
    std::map<std::vector<std::string>, fs::path> tables;  // by the swept values that these hang on
    std::vector<fs::path> dirs;
    for (const SweepRun& run : runs) {
        std::vector<std::string> of_tables;
        for (const std::string& set : run.swept) {
            if (makes_tables_stale(set)) of_tables.push_back(set);
        }
        const fs::path dir = out / run.name;
        dirs.push_back(dir);
        const auto [made, first] = tables.emplace(of_tables, dir);
        Progress progress(quiet, !ranks.leader());  // each plan has its own times
        progress.note(fmt::format("{} ({} of {})", run.name, dirs.size(), runs.size()));
        // A folder that is there already goes on by itself; a run by several ranks is one of all.
        if (first || ranks.count() > 1 || !RunDir(dir).holds_nothing()) {
            JobOptions options;
            options.out = dir;
            options.threads = threads;
            run_job(read_config(job, run.all), options, ranks, progress);
        } else {
            plan_again(made->second, dir, run.swept, threads, progress);
        }
    }
    if (!ranks.leader()) return {};
    Comparison c = compare(dirs);
    write_text(out / "sweep.csv", csv_of(c));
    write_text(out / "sweep.png", picture_of(c));
    return c;
}

}  // namespace vfplan
