// What is said of a job: summary.json, provenance.json, and a few lines for people.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "engine/config/config.h"
#include "engine/plan/planning.h"
#include "engine/runtime/progress.h"
#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"

namespace vfplan {

// What the tables know of how they were made.
nlohmann::ordered_json summary_of_tables(const FieldFile& field, const CoverageTables& coverage);
// The plan's part of summary.json.
nlohmann::ordered_json summary_of_plan(const Planned& planned, const CoverageTables& tables);
// stage_wall_s and the like.
void add_times(nlohmann::ordered_json& summary, const Progress& progress);

// What a person wants to know of a plan, a few lines; and in one.
std::string plan_text(const Planned& planned, const CoverageTables& tables, const Config& config);
std::string plan_line(const Planned& planned);

// provenance.json: what may differ between equal runs.
std::string provenance(const Config& config, const std::string& input_sha256, int threads,
                       int ranks);

}  // namespace vfplan
