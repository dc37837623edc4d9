// The run directory: whose it is, and what is already in it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "engine/config/config.h"

namespace vfplan {

inline constexpr const char* lock_name = ".lock";  // in each run directory
inline constexpr const char* provenance_name = "provenance.json";

// Hashes that tell jobs apart: the tables depend on the first, the whole run on the second.
struct JobKeys {
    std::string tables;
    std::string job;
};

// Hash of what the paths of a configuration lead to. Throws IoError when one leads nowhere.
std::string input_hash(const Config& config);
JobKeys job_keys(const Config& config, const std::string& input_sha256);

class RunDir {
public:
    explicit RunDir(std::filesystem::path path) : path_(std::move(path)) {}

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path file(std::string_view name) const { return path_ / name; }

    // Throws UsageError when the folder holds another job's run or something else, with both
    // hashes; reads only. `fresh`: another job's run may be replaced.
    void check(const JobKeys& keys, bool fresh) const;

    // True where nothing lies in the folder, or it is not there.
    bool holds_nothing() const;

    // provenance.json, which is there as soon as the tables are. Throws UsageError where it is not.
    std::string provenance() const;

    // Makes another run's tables this folder's, by hard links where the file system has them, with
    // a job.toml in which `overrides` count: of what tables do not depend on. Throws IoError, and
    // UsageError where the folder holds more than such a copy that did not come to its end.
    void begin_copy(const RunDir& from, const std::vector<std::string>& overrides) const;

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

}  // namespace vfplan
