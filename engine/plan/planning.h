// From the coverage table to a plan with all that is said of it.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/config/options.h"
#include "engine/plan/join_thresholds.h"
#include "engine/plan/link_ratios.h"
#include "engine/plan/metrics.h"
#include "engine/plan/plan.h"
#include "engine/runtime/progress.h"
#include "io/tables/coverage_file.h"

namespace vfplan {

struct Planned {
    Plan plan;
    PlanReport report;
    Metrics metrics;
    JoinThresholds join_thresholds;
    bool loops = false;  // whether they were asked for
};

// What a plan is made from: about 4 bytes for each entry of the coverage table and 8 for each
// piece. References to what outlives it.
struct PlanTables {
    const CoverageTables& coverage;
    OverlapRows rows;  // with angles where the job's overlap goes by angle
    std::vector<double> piece_length_m;
    AngleSource angles;
};
PlanTables plan_tables_of(const CoverageTables& tables, const CoverageEntries& entries,
                          OverlapRatio ratio);

// Stages overlap, plan, metrics and join_thresholds. The number of threads changes nothing.
Planned plan_stations(const PlanTables& tables, const PlanOptions& options, double range_max_m,
                      const Threads& threads, Progress& progress);

}  // namespace vfplan
