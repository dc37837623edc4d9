// A fast bound: what rows weigh.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/search/problem.h"

namespace vfplan {

enum class WeighUntil : std::uint8_t {
    proven,  // no plan with fewer stations is left, or
    spent,   // always all rounds: as good as they make it
};

// Weights of rows, in parts of proof_scale and not negative, found by subgradients: their sum, less
// what columns gain by them beyond 1, bounds the stations of any cover. `stations`: of a plan that
// is known. Follows from its arguments alone.
std::vector<std::int64_t> weigh_rows(const Problem& problem, std::int64_t stations,
                                     std::int64_t rounds, WeighUntil until = WeighUntil::proven);

}  // namespace vfplan
