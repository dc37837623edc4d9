// From what parts of a site took to what all of it will take.
#pragma once

#include <vector>

#include "engine/job/trial.h"
#include "kernels/layout.h"

namespace vfplan {

// A trial and what it stands for.
struct Weighed {
    Trial trial;
    Layout layout;      // of the cells that were tried
    double weight = 1;  // in a sum over the site; with others that are alike, up to a factor
    double pieces = 1;  // of the job, for each that was tried
};

struct Totals {
    double candidates = 0;
    double entries = 0;  // of the coverage table
    double field_bytes = 0;
    double coverage_bytes = 0;  // shards with rows
    double working_bytes = 0;
    double cpu_s = 0;

    Totals& operator+=(const Totals& o);
};

// What all walls of a site take; `cells` of the job's grid lie around them. The sum of trials by
// weight, `times` so often, is that over the site.
Totals scaled_by_walls(const std::vector<Weighed>& trials, double times, double cells,
                       const Layout& job, double range_m);

// What `cells` of the job's grid without walls take.
Totals scaled_by_cells(const std::vector<Weighed>& trials, double cells, const Layout& job,
                       double range_m);

}  // namespace vfplan
