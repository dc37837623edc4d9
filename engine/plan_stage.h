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

// What a plan is made from: about 4 bytes for each entry of the coverage table and 8 for each
// piece. References to what outlives it.
struct PlanTables {
    const std::vector<Wall>& walls;
    const std::vector<std::int32_t>& first_of;  // Pieces::first_of
    const std::vector<PieceStatus>& reach;
    const std::vector<Candidate>& candidates;
    PieceRows rows;  // with angles where the job's overlap goes by angle
    std::vector<double> piece_length_m;
    AngleSource angles;
};
PlanTables plan_tables_of(const CoverageTables& tables, OverlapRatio ratio);

// The same parts of coverage.h5; angles for the links are read when they are asked for.
PieceRows read_piece_rows(const std::filesystem::path& coverage, bool angles);
AngleSource angles_of(const std::filesystem::path& coverage);

// The same index serves overlap and certificate and is gone when the plan begins.
Planned plan_rows(const PlanOptions& options, double range_max_m, const PlanTables& tables,
                  const Threads& threads, Progress& progress);

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
