// What a job will take, for --dry-run.
#pragma once

#include <cstdint>
#include <string>

#include "engine/config/config.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"

namespace vfplan {

struct Estimate {
    std::int64_t cells = 0;
    std::int64_t free_cells = 0;
    std::int64_t pieces = 0;
    std::int64_t candidates = 0;
    std::int64_t entries = 0;  // of the coverage table
    double memory_mb = 0;      // peak of a process
    double disk_mb = 0;        // of the run directory, finished
    double working_mb = 0;     // more while it runs
    double wall_s = 0;
    bool whole = false;  // the sample was the whole site
};

// Reads the site and makes the tables of some squares of it, in a folder for temporary files that
// is gone afterwards; squares with many walls are likelier to be among them. The rest is scaled by
// walls and cells. Throws as a run would.
Estimate estimate(const Config& config, const Threads& threads, Progress& progress);

std::string estimate_text(const Estimate& estimate, const Config& config, const Threads& threads);

}  // namespace vfplan
