// The whole road from a job to a run directory, and its parts that have commands of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/config/config.h"
#include "engine/runtime/progress.h"
#include "engine/runtime/ranks.h"

namespace vfplan {

struct JobOptions {
    std::filesystem::path out;
    int threads = 0;
    bool fresh = false;    // make everything again, whatever the folder holds
    bool dry_run = false;  // validate and estimate, write nothing
    bool plan = true;      // false: stop behind the tables
    // Above 0: a job that takes more, by its estimate, is refused before it begins.
    double memory_bytes = 0;  // of each process; twice that, as the estimate goes
    double time_s = 0;
};

// run, precompute and --dry-run, by all ranks together. Returns what a person wants to read, on the
// leader. Throws Error.
std::string run_job(const Config& config, const JobOptions& options, const Ranks& ranks,
                    Progress& progress);

// plan DIR: plans again from the tables of a run directory. `overrides` may set what tables do not
// depend on, and overlap.*; else UsageError. With `out` the plan goes into that folder, with the
// tables, and nothing of DIR changes; UsageError where it holds anything.
std::string plan_again(const std::filesystem::path& dir, const std::filesystem::path& out,
                       const std::vector<std::string>& overrides, int threads, Progress& progress);

}  // namespace vfplan
