// A plan and its certificate against the coverage table, by means that share nothing with planning
// but the overlap of two rows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/tables/coverage_file.h"
#include "io/tables/plan_file.h"

namespace vfplan {

struct RunCheck {
    std::vector<std::string> wrong;  // a line each; empty where all is right
    std::int64_t stations = 0;
    std::int64_t bound = 0;  // as the certificate claims
    std::int64_t networks = 0;
    std::int64_t pieces_alone = 0;  // where survival is asked for: as Survival has them
    std::int64_t parting = 0;
};

// Links, networks and what each has to cover anew from the rows; then whether each network of the
// plan covers that and hangs together, and whether each proof proves its bound; where the plan
// says that it survives, also whether it stands the loss of any one station (check_survival).
// Memory as planning.
RunCheck check_plan(const CoverageTables& tables, const CoverageEntries& entries,
                    const PlanTable& plan, const Certificate& certificate);

}  // namespace vfplan
