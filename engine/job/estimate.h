// What a job will take, for --dry-run.
#pragma once

#include <cstdint>
#include <string>

#include "engine/config/config.h"
#include "engine/job/pipeline.h"
#include "engine/job/sample.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"

namespace vfplan {

struct Estimate {
    std::int64_t cells = 0;
    std::int64_t free_cells = 0;
    bool free_cells_exact = true;
    std::int64_t pieces = 0;
    std::int64_t candidates = 0;
    std::int64_t entries = 0;  // of the coverage table
    double memory_mb = 0;      // peak of a process
    double disk_mb = 0;        // of the run directory, finished
    double working_mb = 0;     // more while it runs
    double wall_s = 0;
    Sample sample;
};

// Reads the site and makes the tables of a part of it (engine/job/sample.h), in a folder for
// temporary files that is gone afterwards. Beyond reading the site that takes a few seconds of
// processor time, whatever the job. Throws as a run would, before it begins to work; Stopped within
// a second or two of a signal.
Estimate estimate(const Config& config, const JobOptions& options, Progress& progress);

// Warns of what the machine, or the disk under `out`, has not enough of.
void warn_of_shortage(const Estimate& estimate, const std::filesystem::path& out,
                      Progress& progress);

// Throws UsageError when the job takes more than twice the memory that `options` grant, or more
// than the time, and says what to change.
void check_estimate(const Estimate& estimate, const JobOptions& options, const Threads& threads);

std::string estimate_text(const Estimate& estimate, const Config& config, const Threads& threads);

}  // namespace vfplan
