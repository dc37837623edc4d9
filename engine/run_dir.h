// The run directory: whose it is, and what is already in it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/config.h"

namespace vfplan {

// Hashes that tell jobs apart: the tables depend on the first, the whole run on the second.
struct JobKeys {
    std::string tables;
    std::string job;
};

// `input_sha256`: of the site's file and the file of forbidden polygons.
JobKeys job_keys(const Config& config, const std::string& input_sha256);

class RunDir {
public:
    explicit RunDir(std::filesystem::path path) : path_(std::move(path)) {}

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path file(const char* name) const { return path_ / name; }

    // Throws UsageError when the folder holds another job's run or something else, with both
    // hashes; reads only. `fresh`: another job's run may be replaced.
    void check(const JobKeys& keys, bool fresh) const;

    // Writes job.toml. Throws IoError.
    void write_job(const Config& config, const JobKeys& keys) const;

    // Removes what a plan left (it must not stand beside other tables), or everything of a run.
    void remove_plan() const;
    void remove_run() const;
    // Work in progress, files that a killed process had not finished, tiles of another size than
    // those of field.h5.
    void remove_work() const;

    // The configuration of a finished precompute or run, with overrides. Throws IoError when it is
    // none.
    Config config(const std::vector<std::string>& overrides = {}) const;

private:
    std::string stored_key() const;
    std::filesystem::path path_;
};

// Keeps other jobs from writing into a run directory while this process lives, on one machine and
// where the file system locks for several. All ranks of a job hold it together.
class FolderLock {
public:
    // `leader`: waits some seconds for others to end (processes of a killed mpirun live a little
    // longer), then throws IoError. The other ranks join after the leader.
    FolderLock(const RunDir& dir, bool leader);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

private:
    int file_ = -1;
};

// Takes a run directory for a job: makes the folder, locks it, writes job.toml, clears away what
// `fresh` makes again. So hours of work are not begun for a folder that cannot be written, and
// whoever finds the folder later knows whose it is. What it made goes again unless keep() is
// called, so that a job that never began leaves nothing.
class ClaimedFolder {
public:
    // Throws as RunDir::check() and FolderLock; IoError when the folder cannot be created or
    // written.
    ClaimedFolder(const RunDir& dir, const Config& config, const JobKeys& keys, bool fresh);
    ~ClaimedFolder();
    ClaimedFolder(const ClaimedFolder&) = delete;
    ClaimedFolder& operator=(const ClaimedFolder&) = delete;
    void keep() { kept_ = true; }

private:
    void undo();

    const RunDir& dir_;
    std::optional<FolderLock> lock_;
    bool kept_ = false;
    bool new_job_ = false;                        // there was no job.toml
    std::vector<std::filesystem::path> created_;  // folders, outermost first
};

}  // namespace vfplan
