// Small files, whole or not at all.
#pragma once

#include <filesystem>
#include <string>

#include "io/aside.h"

namespace vfplan {

// Throws an IoError that says what could not be done with a file, why (`error` as errno has it) and
// what to do about it.
[[noreturn]] void fail_on_file(const std::filesystem::path& file, const std::string& what,
                               int error);
// What to do about it, without the file: "the disk is full: free space there and run again".
std::string advice_on(int error);

// True when a name is there, be it a symbolic link that leads nowhere.
bool is_there(const std::filesystem::path& path);
// Makes a folder and those around it, as far as they are missing. Throws IoError.
void make_folders(const std::filesystem::path& folder);

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
    Aside aside_;
    int out_ = -1;
};

}  // namespace vfplan
