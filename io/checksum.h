// The line that ends every binary file of ours: "vfplan sha256 " and the SHA-256 of all before it.
// HDF5 readers do not see it.
#pragma once

#include <filesystem>
#include <string>

namespace vfplan {

// Adds the line to a finished file. False when that fails.
bool add_checksum(const std::filesystem::path& path);

// The hash that a whole file ends with. Throws IoError when there is none or the content has
// another. Looks once in a process at each state of a file. Thread-safe.
std::string checked_hash(const std::filesystem::path& path);

// An IoError for a file that is not whole.
[[noreturn]] void damaged(const std::filesystem::path& path, const std::string& what);

}  // namespace vfplan
