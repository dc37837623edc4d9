// The hash of a job's results.
#pragma once

#include <string>

#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "kernels/candidate.h"

namespace vfplan {

// Of the field, candidates, coverage rows, walls, status of pieces, stations and links, value by
// value: none of it depends on threads, ranks, tiles or machine. In bounded memory. Throws IoError.
std::string result_hash(const FieldFile& field, const CoverageTables& tables,
                        const CoverageEntries& entries, const Plan& plan);

}  // namespace vfplan
