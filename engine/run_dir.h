// The run directory: whose it is, and what is already in it.
#pragma once

#include <filesystem>
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

    // The configuration of a finished precompute or run, with overrides. Throws IoError when it is
    // none.
    Config config(const std::vector<std::string>& overrides = {}) const;

private:
    std::string stored_key() const;
    std::filesystem::path path_;
};

// Holds a run directory that may have to be created, so that hours of work are not begun for a
// folder that cannot be written. Folders that it created go again, unless keep() was called.
class ClaimedFolder {
public:
    // Throws IoError when the folder cannot be created or written.
    explicit ClaimedFolder(const std::filesystem::path& path);
    ~ClaimedFolder();
    ClaimedFolder(const ClaimedFolder&) = delete;
    ClaimedFolder& operator=(const ClaimedFolder&) = delete;
    void keep() { created_.clear(); }

private:
    explicit ClaimedFolder(std::vector<std::filesystem::path> created)
        : created_(std::move(created)) {}
    std::vector<std::filesystem::path> created_;  // outermost first
};

}  // namespace vfplan
