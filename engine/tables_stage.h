// From a site to the field and coverage tables.
#pragma once

#include <memory>
#include <string>

#include "engine/candidates.h"
#include "engine/config.h"
#include "engine/progress.h"
#include "io/site_reader.h"
#include "io/tables.h"
#include "kernels/scanner.h"

namespace vfplan {

SiteOptions site_options(const Config& config);
Scanner scanner_of(const Config& config);
OverlapRatio ratio_of(const std::string& name);
int rays_of(const Config& config);

// A site with its grid, ready for views.
struct Prepared {
    Site site;
    Grid grid;
    Raster<std::uint8_t> standable;  // free and not forbidden
    std::vector<Vec2d> required;     // plan.required and plan.existing in the site frame
    std::vector<Vec2d> existing;
};

// Throws UsageError when the cells do not fit the site or the memory, or a point of the user lies
// where no station can stand.
Prepared prepare(const Config& config, Site site);

// What a job will take, for --dry-run.
struct Estimate {
    std::int64_t cells = 0;
    std::int64_t free_cells = 0;
    std::int64_t pieces = 0;
    std::int64_t candidates = 0;  // order of magnitude
    double memory_mb = 0;
    double disk_mb = 0;
    double field_s = 0;  // from a sample of views on this machine
};
Estimate estimate(const Config& config, const Prepared& prepared, const Threads& threads);

struct Tables {
    FieldTable field;
    CoverageTables coverage;
    CandidateReport report;
    FieldCounts counts;  // of the field
};

// Field, skeleton, candidates, coverage. `key` goes into both tables.
Tables make_tables(const Config& config, const Prepared& prepared, const std::string& key,
                   const Threads& threads, Progress& progress);

}  // namespace vfplan
