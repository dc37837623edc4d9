// Files in the making. Each stands aside, as NAME.tmp, until it is whole, so that nobody ever sees
// half of it under its own name.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>

namespace vfplan {

// The place of one file in the making. Throws IoError. One thread at a time; several objects may be
// used at once. What lies there before (of a process that was killed, or a symbolic link) is
// removed and never written through: who creates the file does so with O_EXCL, or inside the
// folder.
class Aside {
public:
    // `in_folder`: NAME.tmp is a new folder that only this user may enter, and path() is NAME in
    // it: for libraries that put journals beside their file.
    explicit Aside(std::filesystem::path file, bool in_folder = false);
    ~Aside();  // removes what is there, unless it was published
    Aside(const Aside&) = delete;
    Aside& operator=(const Aside&) = delete;

    const std::filesystem::path& path() const { return path_; }
    // Creates path() anew and returns a descriptor to write to, which the caller closes.
    int create() const;
    // Gives the finished file its name: sync, rename, sync the folder.
    void publish();

private:
    void remove() noexcept;

    std::filesystem::path file_;
    std::filesystem::path folder_;  // empty where there is none
    std::filesystem::path path_;
    std::array<std::size_t, 5> slots_{};  // where remove_asides() finds the names, from 1
    bool published_ = false;
};

// Brings the names in a folder to the disk. Throws IoError.
void sync_folder(const std::filesystem::path& folder);

// Removes what is in the making in this process. Only what a signal handler may do; afterwards the
// process must end.
void remove_asides() noexcept;

}  // namespace vfplan
