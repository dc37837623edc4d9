// The tables of a part of a site, made for what they take.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "engine/config/options.h"
#include "engine/runtime/parallel.h"
#include "kernels/wall.h"

namespace vfplan {

// Without what every file and every phase takes, however little there is to do.
struct Trial {
    double cells = 0;
    double free_cells = 0;
    double candidates = 0;
    double entries = 0;  // of the coverage table
    double field_bytes = 0;
    double coverage_bytes = 0;            // shards with rows
    double working_bytes = 0;             // in work/
    std::map<std::string, double> cpu_s;  // by phase
};

// Makes the tables in a folder for temporary files that is gone afterwards, however it ends. A part
// where nothing can be seen has a field and no candidates. Throws as a run would.
Trial try_part(const GroundOptions& ground, const TableOptions& tables, const Site& site,
               const Threads& threads);

}  // namespace vfplan
