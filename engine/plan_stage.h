// From the coverage tables to a plan, and all files of it.
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
};

PlanOptions plan_options(const Config& config);

Planned plan_tables(const Config& config, const CoverageTables& tables, const Threads& threads,
                    Progress& progress);

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
