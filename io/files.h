// Small files, whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace vfplan {

// Reads a text file. Throws IoError.
std::string read_text(const std::filesystem::path& file);

// Writes aside, syncs and renames. Throws IoError.
void write_text(const std::filesystem::path& file, const std::string& text);

// A text file that comes bit by bit; without close() nothing of it stays. Throws IoError.
class TextFile {
public:
    explicit TextFile(std::filesystem::path file);
    ~TextFile();
    TextFile(const TextFile&) = delete;
    TextFile& operator=(const TextFile&) = delete;
    void add(const std::string& text);
    void close();

private:
    std::filesystem::path file_;
    std::filesystem::path aside_;
    std::ofstream out_;
};

// Gives a finished file its name: sync, rename, sync the folder. Throws IoError.
void publish(const std::filesystem::path& aside, const std::filesystem::path& file);

}  // namespace vfplan
