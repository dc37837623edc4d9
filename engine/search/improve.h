// Better plans by ruin and recreate (docs/planning.md).
#pragma once

#include <cstdint>

#include "engine/search/problem.h"

namespace vfplan {

struct ImproveOptions {
    std::int64_t steps = 0;
    std::uint64_t seed = 0;
    // Closes loops at any cost in the end, so that nothing stays loose that the problem could
    // close.
    bool finish = true;
};

// Drops a ball of stations, covers what they covered anew by rare rows and parts touched, joins the
// parts by shortest paths, takes out what is not needed any more, and keeps the result when it is
// not worse, or now and then a little; `steps` times. Fewer stations off a cycle come first where
// the problem counts cycles, then fewer stations; each two that stand too near by cost half a one.
// Returns the best plan that was met, with no station in it that could just go: never worse than
// `start`, which is a plan. Follows from its arguments alone. Thread-safe.
Choice improve(const Problem& problem, const Choice& start, const ImproveOptions& options);

// Only that: adds the fewest columns for each loose one that put it on a cycle. No more where
// cycles do not count.
Choice close_all(const Problem& problem, const Choice& start);

}  // namespace vfplan
