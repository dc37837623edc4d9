// Which names in a run directory are ours. Nothing else there is ever removed or written over.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace vfplan {

inline constexpr const char* job_name = "job.toml";
inline constexpr const char* summary_name = "summary.json";
inline constexpr const char* provenance_name = "provenance.json";
inline constexpr const char* plan_name = "plan.h5";
inline constexpr const char* field_name = "field.h5";

// The files of a plan but for summary.json: plan.h5 and all that output.formats can name.
std::vector<std::string> plan_files();
// The tables: field.h5, coverage.h5, pool.h5.
std::vector<std::string> table_files();

// Names of files in shards/ and in work/tiles-SIDE/, finished or in the making.
bool is_shard_name(std::string_view name);
bool is_passing_name(std::string_view name);

// Throws IoError when a name of ours in the folder is a symbolic link, or what must be a file or a
// folder is something else: we write through no links.
void refuse_links(const std::filesystem::path& folder);

// Each removes the names that are ours and no others; a folder goes when it is empty then. Quietly
// leaves what cannot be removed.
void remove_plan_files(const std::filesystem::path& folder);  // summary.json first
void remove_tables(const std::filesystem::path& folder);      // indices, provenance.json, shards/
void remove_passing(const std::filesystem::path& folder);     // work/
void remove_unfinished(const std::filesystem::path& folder);  // what a killed process left
// Shards of the field but for those of tiles of this side.
void remove_other_tiles(const std::filesystem::path& folder, std::int64_t tile_cells);

}  // namespace vfplan
