// Trying a job on some squares of its site.
#pragma once

#include "engine/config/options.h"
#include "engine/runtime/parallel.h"
#include "kernels/wall.h"

namespace vfplan {

// What the tables of some squares took.
struct Sample {
    bool whole = false;  // the squares are the whole site
    double share = 1;    // of the site's wall length that lies in them
    double cpu_s = 0;
    double candidates = 0;
    double entries = 0;  // of the coverage table
    double field_bytes = 0;
    double coverage_bytes = 0;  // shards with rows
    double working_bytes = 0;
};

// Makes the tables of some squares in a folder for temporary files that is gone afterwards; squares
// with many walls are likelier to be among them. Throws as a run would.
Sample try_squares(const GroundOptions& ground, const TableOptions& tables, const Site& site,
                   const Threads& threads);

}  // namespace vfplan
