// Trying a job on a part of its site, in a bounded time.
#pragma once

#include "engine/config/options.h"
#include "engine/job/scaling.h"
#include "kernels/layout.h"
#include "kernels/wall.h"

namespace vfplan {

struct Sample {
    Totals site;             // what the tables of the whole site will take
    double share = 0;        // of the site's wall length that was tried
    int squares = 0;         // in so many squares; 0: the site as it is
    double cell_m = 0;       // of the cells that were tried
    bool cut_short = false;  // by the clock
};

// Makes the tables of the whole site, if it is small, else of some squares of it; squares with much
// wall are likelier to be among them.
//  (1) cells are tried larger, pieces longer and squares smaller where they would be too many:
//      work is bounded by counts, and in the end by a clock, a few seconds of processor time in all
//  (2) cells that are tried are at most a 32nd of the distance that one sees, or the job's own
// Throws Stopped soon after a signal; else as a run would.
Sample try_job(const GroundOptions& ground, const TableOptions& tables, const Site& site,
               const Layout& layout, int threads);

}  // namespace vfplan
