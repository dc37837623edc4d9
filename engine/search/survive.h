// Plans that stand the loss of any one of their stations (docs/planning.md).
#pragma once

#include <cstdint>

#include "engine/search/problem.h"

namespace vfplan {

// Plans of more stations are made to survive, but not searched for fewer stations then.
inline constexpr std::size_t survival_searched_most = 2000;

// A plan that survives, from `start`, which is a plan of the problem:
//  (1) every row that two columns cover is covered by two of the plan at least
//  (2) of each block of the graph (what no single column's loss divides) with three columns or more
//      the plan has none, or one, or a part of three or more that no single one's loss divides. So
//      a station whose loss parts the plan parts the graph itself, and each of the plan's parts
//      then lies in another of the graph's
// Fixed columns stay. Searched with so many steps; `seed` for its chances. Follows from its
// arguments alone. Thread-safe.
Choice survive(const Problem& problem, const Choice& start, std::int64_t steps, std::uint64_t seed);

}  // namespace vfplan
