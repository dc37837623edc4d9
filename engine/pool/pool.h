// More candidates, off the ridges: pool.h5 (docs/method.md 6).
#pragma once

#include <filesystem>
#include <string>

#include "engine/config/options.h"
#include "engine/runtime/progress.h"
#include "engine/runtime/ranks.h"

namespace vfplan {

// What pool.h5 and its shards belong to. `tables_key`: that of the tables.
std::string pool_key(const std::string& tables_key, const PoolOptions& options);

// Makes pool.h5 of a run directory with complete tables, on all ranks together, unless it is there
// and whole. It follows from the tables and the options. Two rounds: pieces are weighed by the
// candidates that there are (phases "weights-1", "weights-2"), and squares of the grid are searched
// for points that cover more than any of these (phases "points-1", "points-2"); then their rows
// (phase "pool"). The squares follow from the grid and the number of candidates, so tiles, ranks
// and threads change nothing. Leaves shards of work in progress in work/. Throws Error.
void make_pool(const std::filesystem::path& dir, const PoolOptions& options, const Threads& threads,
               const Ranks& ranks, Progress& progress);

}  // namespace vfplan
