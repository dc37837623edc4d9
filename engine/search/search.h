// Better plans of problems of any size (docs/planning.md).
#pragma once

#include <cstdint>
#include <functional>

#include "engine/runtime/parallel.h"
#include "engine/search/problem.h"

namespace vfplan {

struct SearchOptions {
    std::int64_t effort = 0;  // steps for each station of the start
    std::uint64_t seed = 0;
    // Called with a number of steps that were done, from any thread; about search_steps() in all.
    std::function<void(std::int64_t)> done = {};
};
std::int64_t search_steps(std::size_t stations, std::int64_t effort);

// improve() on the whole, or, of a plan with many stations, on windows of it in turn, at the same
// time where they do not touch. Never worse than `start`, which is a plan. No station of the result
// could just go; none is loose. The number of threads changes nothing.
Choice search(const Threads& threads, const Problem& problem, const Choice& start,
              const SearchOptions& options);

}  // namespace vfplan
