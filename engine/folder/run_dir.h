// The run directory: whose it is, and what is already in it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/config.h"

namespace vfplan {

// Hashes that tell jobs apart: the tables depend on the first, the whole run on the second. Both
// depend on what the values in shards mean, which changes with the program (tables_version).
struct JobKeys {
    std::string tables;
    std::string job;
};

// Raised with every change of the program that makes other shards or tables of the same job.
// tests/golden holds it beside the hashes of tables, and fails when those change without it.
inline constexpr int tables_version = 6;

JobKeys job_keys(const Config& config, const std::string& input_sha256);

class RunDir {
public:
    explicit RunDir(std::filesystem::path path) : path_(std::move(path)) {}

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path file(std::string_view name) const { return path_ / name; }

    // A folder is ours when it has our mark (.lock) and a job.toml that begins with our two lines;
    // where nothing lies, it may become ours. Throws UsageError when the folder holds anything
    // else, or another job's run, with both hashes; IoError when a name of ours is a symbolic link.
    // Reads only. `fresh`: another job's run may be replaced, unless its job.toml was changed by
    // hand.
    void check(const JobKeys& keys, bool fresh) const;

    // True where nothing lies in the folder, or it is not there.
    bool holds_nothing() const;

    // Throws UsageError where the folder is not ours.
    void check_ours() const;

    // Throws IoError when job.toml is not of the job that made tables with this key.
    void check_job(const std::string& tables_key) const;

    // provenance.json, which is there as soon as the tables are. Throws UsageError where it is not.
    std::string provenance() const;

    // Makes another run's tables this folder's, by hard links where the file system has them, with
    // a job.toml in which `overrides` count: of what tables do not depend on. Throws IoError, and
    // UsageError where the folder holds more than such a copy that did not come to its end.
    void begin_copy(const RunDir& from, const std::vector<std::string>& overrides) const;

    // Writes job.toml. Throws IoError.
    void write_job(const Config& config, const JobKeys& keys) const;

    // Removes what a plan left (it must not stand beside other tables), or everything of a run. Of
    // all that lies in the folder only what we write: engine/folder/contents.h.
    void remove_plan() const;
    void remove_run() const;
    // Work in progress, files that a killed process had not finished, tiles of another size than
    // those of field.h5.
    void remove_work() const;

    // The configuration of a finished precompute or run, with overrides. Throws IoError when it is
    // none.
    Config config(const std::vector<std::string>& overrides = {}) const;

private:
    // What the first two lines of job.toml say, and whether the second is true of the rest.
    struct Header {
        std::string key;
        int version = 0;
        bool whole = false;
    };
    Header header() const;
    std::string input_sha256() const;

    std::filesystem::path path_;
};

}  // namespace vfplan
