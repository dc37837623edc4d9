// From the coverage tables to a plan that the exact kernel agrees with, and all files of it.
#pragma once

#include <nlohmann/json.hpp>

#include "engine/config.h"
#include "engine/joining.h"
#include "engine/metrics.h"
#include "engine/planner.h"
#include "engine/progress.h"
#include "engine/run_dir.h"
#include "io/tables.h"

namespace vfplan {

struct Planned {
    Plan plan;
    PlanReport report;
    Metrics metrics;
    Joining joining;
    std::int64_t rows_corrected = 0;  // stations whose row the exact kernel saw otherwise
};

PlanOptions plan_options(const Config& config);

// Plans; with `confirm`, looks from each station with the exact kernel too, puts its row in the
// table where the two differ, and plans again until they agree.
Planned plan_tables(const Config& config, CoverageTables& tables, bool confirm,
                    const Threads& threads, Progress& progress);

// Hash of all that must not depend on threads, ranks, tiles or machine.
std::string result_hash(const FieldTable& field, const CoverageTables& tables, const Plan& plan);

// The plan's part of summary.json.
nlohmann::ordered_json summary_of(const Planned& planned, const CoverageTables& tables);

// plan.h5, CSV, GeoJSON and map.png, as config.output.formats asks.
void write_plan_files(const RunDir& dir, const Config& config, const FieldTable& field,
                      const CoverageTables& tables, const Planned& planned);

// What a person wants to know of it, a few lines.
std::string plan_text(const Planned& planned, const CoverageTables& tables, const Config& config);

}  // namespace vfplan
