// Tables over shards: what field.h5 and coverage.h5 have in common.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/h5_reader.h"
#include "io/h5_writer.h"

namespace vfplan {

// A table of the run directory: begun with its header, ended with the mark that it is complete.
h5::Writer begin_table(const std::filesystem::path& path, const std::string& title,
                       const std::string& key);
void finish_table(h5::Writer& file);
// Throws IoError for a table that another version of the program wrote.
void check_version(const h5::Reader& file, const std::filesystem::path& path);

// The shards of an index: `tile_status` of each (1: complete) and the SHA-256 of its content, 32
// bytes each. Their names are those of `shards` from their number on; all lie in one folder.
void write_shard_list(h5::Writer& file, const std::vector<std::filesystem::path>& shards);

// "shards/NAME" of a shard, as its index names it.
std::string name_in_index(const std::filesystem::path& shard);

// The shards of an index, by names of ours in the folder beside it. Throws IoError, naming it, for
// the first that is missing, damaged or another, and for an index that names others.
std::vector<std::filesystem::path> check_shards(const std::filesystem::path& index);

// Throws IoError where a virtual dataset, which other programs read, consists of anything else.
void check_sources(const h5::Reader& file, const std::string& name,
                   const std::vector<h5::Source>& wanted);

}  // namespace vfplan
