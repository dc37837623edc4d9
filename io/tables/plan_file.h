// plan.h5: stations, links, the status of each piece, the certificate of the bound.
#pragma once

#include <filesystem>
#include <string>

#include "kernels/candidate.h"
#include "kernels/overlap.h"

namespace vfplan {

struct PlanTable {
    Plan plan;
    std::string key;  // of the coverage table that it was made from
    OverlapRule overlap;
    CandidatePool pool = CandidatePool::axis;
    bool survives = false;  // made to stand the loss of any one station
};
// Whole or not at all. Throws IoError.
void write_plan(const std::filesystem::path& path, const PlanTable& table);
PlanTable read_plan(const std::filesystem::path& path);

}  // namespace vfplan
