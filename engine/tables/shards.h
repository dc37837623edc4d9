// The way from a site to its tables is cut into phases of independent tasks. Each task writes one
// immutable shard; a task whose shard is there already is not done again. So a job may be killed at
// any instant, shared by any number of ranks, and its result is the same.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "engine/runtime/progress.h"
#include "engine/runtime/ranks.h"
#include "engine/tables/scenes.h"
#include "io/tables/shard.h"
#include "kernels/layout.h"

namespace vfplan {

// What every phase needs. Lives as long as tables are made; the same on all ranks. Refers to what
// outlives it.
struct TableJob {
    const std::filesystem::path& dir;  // run directory
    const std::string& key;            // of the tables, in every shard
    const Threads& threads;
    const Ranks& ranks;
    Progress& progress;
    Scenes& scenes;

    const Layout& layout() const { return scenes.layout(); }
    // Cells that the scanner's range spans, rounded up.
    std::int32_t range_cells() const;
    // Of shards that stay, and of those of work in progress.
    ShardNames kept(const std::string& phase, const std::string& variant = "") const;
    ShardNames passing(const std::string& phase, const std::string& variant = "") const;
};

// The folders that shards lie in. Throws IoError.
void make_shard_folders(const std::filesystem::path& dir, std::int64_t tile_cells);

// True when a shard (or a table, or site.h5) is there, whole, of this job and under its own name.
// What is damaged or of another job is named in a warning and gone afterwards.
bool have_shard(const std::filesystem::path& path, const std::string& key, Progress& progress);
// The same of a table and all shards that it names.
bool have_table(const std::filesystem::path& path, const std::string& key, Progress& progress);

using MakeShard = std::function<void(std::int64_t number, const std::filesystem::path& path)>;

// Makes the shards 0..n-1 of a phase that are missing, over all ranks. A barrier. `task_bytes`:
// what a task holds in memory, where that is much; no more of them are worked on at once than there
// is room for, and the threads share these. What is no Error leaves with the shard's name and the
// command that repeats the task.
void make_shards(const TableJob& job, const ShardNames& names, std::int64_t n,
                 const MakeShard& make, double task_bytes = 0);

// The same for a single file, made by the leader.
void make_one(const TableJob& job, const std::string& phase, const std::filesystem::path& path,
              const std::function<void(const std::filesystem::path&)>& make);

}  // namespace vfplan
