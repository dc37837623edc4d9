// Better plans of problems of any size (docs/planning.md).
#pragma once

#include <cstdint>

#include "engine/runtime/parallel.h"
#include "engine/search/problem.h"

namespace vfplan {

struct SearchOptions {
    std::int64_t effort = 0;  // steps for each station of the start
    std::uint64_t seed = 0;
};

// improve() on the whole, or, of a plan with many stations, on windows of it in turn, at the same
// time where they do not touch. Never worse than `start`, which is a plan. No station of the result
// could just go; none is loose. The number of threads changes nothing.
Choice search(const Threads& threads, const Problem& problem, const Choice& start,
              const SearchOptions& options);

}  // namespace vfplan
