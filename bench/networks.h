// The main network of a benchmark's site: what the planner's search works on.
#pragma once

#include <string>
#include <vector>

#include "engine/config/options.h"
#include "engine/search/problem.h"

namespace vfplan::bench {

struct MainNetwork {
    Sparse table;                        // pieces of every candidate, pool included
    std::vector<double> piece_length_m;  // of the table
    Problem problem;                     // of the component that covers most, with all its loops
    std::vector<double> row_length_m;    // of a piece of each of the problem's rows
    Choice greedy;                       // Algorithm 1
    double greedy_s = 0;                 // processor time that it took
    PlanOptions options;
};

// Made at first use; nullptr where the site's data are missing.
const MainNetwork* main_network(const std::string& site);

}  // namespace vfplan::bench
