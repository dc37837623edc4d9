// Who may work in a run directory.
#pragma once

#include <chrono>
#include <filesystem>

namespace vfplan {

inline constexpr const char* lock_name = ".lock";    // in each run directory; also its mark as ours
inline constexpr const char* ranks_name = ".ranks";  // where several processes worked together

// An open file, closed with the object; -1: none.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { close(); }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    int number() const { return number_; }
    // Instead of the one that was open.
    void take(int number) {
        close();
        number_ = number;
    }
    void close();

private:
    int number_;
};

// Keeps other jobs out of a run directory while this process lives: on one machine, and on several
// where the file system passes flock() on (NFS from version 3 on does, Lustre when it is mounted
// with flock). A file that cannot be opened or locked is an IoError, never a free folder.
//
// .lock is held by the one process that leads a job, or shared by those who copy from a finished
// one. .ranks is shared by the other processes of a job: those of a killed mpirun live a little
// longer than their leader, and the next leader waits for them.
class FolderLock {
public:
    enum class Hold { lead, follow, copy };
    // Waits for others to end, at most as long as `patience`, then throws IoError. REQUIRES: the
    // folder is there; followers come after their leader.
    FolderLock(const std::filesystem::path& folder, Hold hold,
               std::chrono::milliseconds patience = std::chrono::seconds(10));
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

    // The folder goes with all in it: takes the file away too. Whoever waits for it notices.
    // REQUIRES: led, and nobody follows any more.
    void remove();

private:
    std::filesystem::path file_;
    Descriptor lock_;
};

// True when the folder is marked as a run directory of ours.
bool is_marked(const std::filesystem::path& folder);

}  // namespace vfplan
