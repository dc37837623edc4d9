// The way from a site to its tables, cut into phases of independent tasks. Each task writes one
// immutable shard; a task whose shard is there already is not done again. So a job may be killed at
// any instant, shared by any number of ranks, and its result is the same.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/config.h"
#include "engine/progress.h"
#include "engine/ranks.h"
#include "engine/scenes.h"
#include "io/site_store.h"
#include "kernels/overlap.h"

namespace vfplan {

// What every phase needs. Lives as long as make_tables() runs; the same on all ranks.
struct Work {
    const Config& config;
    const std::filesystem::path& dir;  // run directory
    const std::string& key;            // of the tables, in every shard
    const Threads& threads;
    const Ranks& ranks;
    Progress& progress;
    const SiteStore& store;
    Scenes& scenes;

    const Layout& layout() const { return store.layout(); }
    OverlapRatio ratio() const;
    double threshold() const { return config.overlap.threshold; }
    // Cells that the scanner's range spans, rounded up.
    std::int32_t range_cells() const;

    // Shards that stay: shards/NAME-NUMBER.h5; and those of work in progress: work/...
    std::filesystem::path kept(const std::string& name, std::int64_t number) const;
    std::filesystem::path passing(const std::string& name, std::int64_t number) const;
};

// True when a shard (or an index, or site.h5) is there, whole, of this job and under its own name.
// What is damaged or of another job is named in a note and gone afterwards.
bool have_shard(const std::filesystem::path& path, const std::string& key, Progress& progress);

// "warning: ...; it is made again", from an error's message up to its first semicolon.
void note_made_again(const std::string& why, Progress& progress);

// Makes the shards 0..n-1 that are missing, over all ranks. A barrier.
void make_shards(const Work& work, const std::string& stage, std::int64_t n,
                 const std::function<std::filesystem::path(std::int64_t)>& path_of,
                 const std::function<void(std::int64_t, const std::filesystem::path&)>& make);

// The same for a single one, made by the leader.
void make_shard(const Work& work, const std::string& stage, const std::filesystem::path& path,
                const std::function<void(const std::filesystem::path&)>& make);

// A file with the key already in it, for a shard's content.
h5::Writer shard_writer(const std::filesystem::path& path, const std::string& key);
void finish_shard(h5::Writer& file);

}  // namespace vfplan
