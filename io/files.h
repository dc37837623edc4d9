// Small files, whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace vfplan {

// Reads a text file. Throws IoError.
std::string read_text(const std::filesystem::path& file);

// Writes aside, syncs and renames. Throws IoError.
void write_text(const std::filesystem::path& file, const std::string& text);

// Gives a finished file its name: sync, rename, sync the folder. Throws IoError.
void publish(const std::filesystem::path& aside, const std::filesystem::path& file);

}  // namespace vfplan
