// Better places for the stations of a plan that has as few as were found.
#pragma once

#include <functional>

#include "engine/search/choosing.h"
#include "engine/search/problem.h"

namespace vfplan {

// How good a column's place is beside the chosen ones but `without`.
using PlaceScore =
    std::function<double(std::int32_t column, const Choosing& chosen, std::int32_t without)>;

// Moves stations one by one to columns of a higher score that leave the plan one, with no more
// stations loose; a few rounds, or until none moves. What is not needed any more goes. Never more
// stations than `start`, which is a plan. Takes time with the square of the plan. Follows from its
// arguments alone. Thread-safe.
Choice settle(const Problem& problem, const Choice& start, const PlaceScore& score);

}  // namespace vfplan
