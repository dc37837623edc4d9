// Whose a run directory is while a job runs.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "engine/folder/lock.h"
#include "engine/folder/run_dir.h"
#include "engine/runtime/ranks.h"

namespace vfplan {

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

// A job in its folder, on all ranks together: claims and locks the folder, calls `tables` and then
// `rest`, and lets the folder go. When `tables` says that the job cannot be done as it stands (a
// UsageError, an InputError), what the claim made goes again; whatever else ends it, shards stay.
void run_in_folder(const RunDir& dir, const Config& config, const JobKeys& keys, bool fresh,
                   const Ranks& ranks, const std::function<void()>& tables,
                   const std::function<void()>& rest);

}  // namespace vfplan
