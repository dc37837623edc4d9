#include "engine/job/claim.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "engine/runtime/stop.h"
#include "kernels/error.h"

namespace vfplan {

FolderLock::FolderLock(const RunDir& dir, bool leader) {
    constexpr int tries = 40;
    constexpr auto pause = std::chrono::milliseconds(250);
    file_ = ::open(dir.file(lock_name).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (file_ < 0) return;  // a folder that cannot be written is told elsewhere
    for (int i = 0; ::flock(file_, (leader ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0; ++i) {
        if (errno != EWOULDBLOCK && errno != EINTR) return;  // no locks here
        stop_if_asked();
        if (i == tries) {
            ::close(file_);
            file_ = -1;
            throw IoError(fmt::format(
                "{}: another vfplan is writing into this folder; wait for it or end it, or choose "
                "another --out",
                dir.path().string()));
        }
        std::this_thread::sleep_for(pause);
    }
    // From now on other leaders are kept out, and the ranks of this job are let in.
    if (leader) ::flock(file_, LOCK_SH);
}

FolderLock::~FolderLock() {
    if (file_ >= 0) ::close(file_);
}

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
        lock_.emplace(dir, true);
        dir.check(keys, fresh);  // whoever held it may have left something
        new_job_ = !std::filesystem::exists(dir.file("job.toml"), error);
        if (fresh) dir.remove_run();
        dir.write_job(config, keys);
        for (const char* name : {"shards", "work"}) {
            std::filesystem::create_directories(dir.file(name), error);
            if (!error) continue;
            throw IoError(fmt::format("{}: cannot create: {}; check free space and permissions",
                                      dir.file(name).string(), error.message()));
        }
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
        std::filesystem::remove(dir_.file("job.toml"), ignored);
    }
    if (lock_ && !created_.empty()) std::filesystem::remove(dir_.file(lock_name), ignored);
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
        if (!ranks.leader()) lock.emplace(dir, false);
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
