#include "engine/folder/claim.h"

#include <fmt/format.h>

#include "engine/folder/contents.h"
#include "io/files.h"
#include "kernels/error.h"

namespace vfplan {

ClaimedFolder::ClaimedFolder(const RunDir& dir, const Config& config, const JobKeys& keys,
                             bool fresh)
    : dir_(dir) {
    dir.check(keys, fresh);
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(dir.path()).lexically_normal();
    std::filesystem::path part;
    for (const std::filesystem::path& name : whole) {
        part /= name;
        if (std::filesystem::exists(part, error)) continue;
        if (!std::filesystem::create_directory(part, error) || error) break;
        created_.push_back(part);
    }
    try {
        if (!std::filesystem::is_directory(whole, error)) {
            throw IoError(fmt::format("{}: the folder cannot be created; choose another --out",
                                      dir.path().string()));
        }
        lock_.emplace(dir.path(), FolderLock::Hold::lead);
        dir.check(keys, fresh);  // whoever held it may have left something
        new_job_ = !std::filesystem::exists(dir.file(job_name), error);
        if (fresh) dir.remove_run();
        dir.write_job(config, keys);
        for (const char* name : {"shards", "work"}) make_folders(dir.file(name));
    } catch (...) {
        undo();
        throw;
    }
}

ClaimedFolder::~ClaimedFolder() {
    if (!kept_) undo();
}

void ClaimedFolder::undo() {
    std::error_code ignored;
    if (new_job_) {
        dir_.remove_run();
        std::filesystem::remove(dir_.file(job_name), ignored);
    }
    if (lock_ && !created_.empty()) lock_->remove();
    for (auto p = created_.rbegin(); p != created_.rend(); ++p) {
        std::filesystem::remove(*p, ignored);  // only while empty
    }
}

void run_in_folder(const RunDir& dir, const Config& config, const JobKeys& keys, bool fresh,
                   const Ranks& ranks, const std::function<void()>& tables,
                   const std::function<void()>& rest) {
    std::optional<FolderLock> lock;      // the other ranks'
    std::optional<ClaimedFolder> claim;  // the leader's
    try {
        ranks.lead([&] { claim.emplace(dir, config, keys, fresh); });
        if (!ranks.leader()) lock.emplace(dir.path(), FolderLock::Hold::follow);
        tables();
    } catch (const Error& e) {
        if (claim && e.code() != Exit::usage && e.code() != Exit::input) claim->keep();
        throw;
    } catch (...) {  // out of memory, say
        if (claim) claim->keep();
        throw;
    }
    if (claim) claim->keep();
    rest();
}

}  // namespace vfplan
