// From a site to the field and coverage tables.
#pragma once

#include <filesystem>
#include <string>

#include "engine/config.h"
#include "engine/progress.h"
#include "engine/ranks.h"
#include "engine/scenes.h"
#include "kernels/scanner.h"

namespace vfplan {

Scanner scanner_of(const Config& config);
OverlapRatio ratio_of(const std::string& name);
int rays_of(const Config& config);
SceneOptions scene_options(const Config& config);

// True when field.h5 and coverage.h5 are of this job and all their shards are there and whole. What
// is not is named in a note; an index without all its shards is removed.
bool tables_complete(const std::filesystem::path& dir, const std::string& key, Progress& progress);

// work/site.h5, on the leader alone, unless it is there. Throws as read_job_site() and
// store_site().
void make_site(const Config& config, const std::filesystem::path& dir, const std::string& key,
               const Threads& threads, Progress& progress);

// Makes what is missing of field.h5 and coverage.h5 in a run directory, on all ranks together:
// every phase leaves shards, so an end at any instant loses little. Equal jobs give equal bytes;
// of the field's shards with equal tiles, of all else always. REQUIRES: work/site.h5. Throws Error.
void make_tables(const Config& config, const std::filesystem::path& dir, const std::string& key,
                 const Threads& threads, const Ranks& ranks, Progress& progress);

}  // namespace vfplan
