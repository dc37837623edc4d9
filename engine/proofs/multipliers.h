// A fast bound: what rows weigh.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/problem.h"

namespace vfplan {

// Weights of rows, in parts of proof_scale and not negative, found by subgradients: their sum, less
// what columns gain by them beyond 1, bounds the stations of any cover. `stations`: of a plan that
// is known. Stops after `rounds`, or where no better plan is left. Follows from its arguments
// alone.
std::vector<std::int64_t> weigh_rows(const Problem& problem, std::int64_t stations,
                                     std::int64_t rounds);

}  // namespace vfplan
