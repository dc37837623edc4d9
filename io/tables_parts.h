// What the tables on disk have in common.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/h5.h"
#include "kernels/vec.h"

namespace vfplan {

void write_header(h5::Writer& file, const std::filesystem::path& path, const std::string& title,
                  const std::string& key);
void finish(h5::Writer& file);

void write_crs(h5::Writer& file, const std::string& crs_wkt, const Vec2d& origin);
std::string read_crs(const h5::Reader& file, Vec2d& origin);

// The shards of an index: `status` of each (1: complete) and the SHA-256 of its content, 32 bytes
// each. Their names are those of `shards` from their number on; all lie in one folder.
void write_shard_list(h5::Writer& file, const std::vector<std::filesystem::path>& shards);

// "shards/NAME" of a shard, as its index names it.
std::string name_in_index(const std::filesystem::path& shard);

}  // namespace vfplan
