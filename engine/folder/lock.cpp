#include "engine/folder/lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string_view>
#include <thread>
#include <utility>

#include "engine/runtime/stop.h"
#include "io/files.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr std::string_view mark = "vfplan run directory\n";

// One try to lock an open file. Throws where the file system cannot say.
bool try_lock(int descriptor, int how, const std::filesystem::path& file) {
    while (::flock(descriptor, how | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK) return false;
        if (errno == EINTR) continue;
        throw IoError(fmt::format(
            "{}: cannot be locked: {}; the file system must pass locks on (flock), and this user "
            "must be let in; choose another --out, on a local disk say",
            file.string(), std::strerror(errno)));
    }
    return true;
}

// Opens for writing where that is allowed, as some network file systems want it; another user's may
// be locked all the same.
int open_lock(const std::filesystem::path& file, bool create) {
    constexpr int flags = O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK;
    int out = ::open(file.c_str(), flags | O_RDWR | (create ? O_CREAT : 0), 0666);
    if (out < 0 && (errno == EACCES || errno == EPERM || errno == EROFS)) {
        out = ::open(file.c_str(), flags | O_RDONLY);
    }
    if (out >= 0 || (!create && errno == ENOENT)) return out;
    throw IoError(
        fmt::format("{}: cannot be opened: {}; without it nobody knows whether another job writes "
                    "into the folder; check its permissions, or choose another --out",
                    file.string(), std::strerror(errno)));
}

bool same_file(int descriptor, const std::filesystem::path& file) {
    struct stat open {};
    struct stat named {};
    return ::fstat(descriptor, &open) == 0 && ::lstat(file.c_str(), &named) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

class Patience {
public:
    Patience(const std::filesystem::path& folder, std::chrono::milliseconds most)
        : folder_(folder), until_(std::chrono::steady_clock::now() + most) {}
    void wait() {
        stop_if_asked();
        if (std::chrono::steady_clock::now() > until_) {
            throw IoError(fmt::format(
                "{}: another vfplan is writing into this folder; wait for it or end it, or choose "
                "another --out",
                folder_.string()));
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }

private:
    const std::filesystem::path& folder_;
    std::chrono::steady_clock::time_point until_;
};

// Followers of a job whose leader was killed. New ones come with this leader only.
void wait_for_followers(const std::filesystem::path& folder, Patience& patience) {
    const std::filesystem::path file = folder / ranks_name;
    const Descriptor ranks(open_lock(file, false));
    if (ranks.number() < 0) return;
    while (!try_lock(ranks.number(), LOCK_EX, file)) patience.wait();
}

void write_mark(int descriptor, const std::filesystem::path& file) {
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || status.st_size != 0) return;
    if (::write(descriptor, mark.data(), mark.size()) != static_cast<ssize_t>(mark.size())) {
        fail_on_file(file, "write", errno);
    }
}

}  // namespace

void Descriptor::close() {
    if (number_ >= 0) ::close(std::exchange(number_, -1));
}

FolderLock::FolderLock(const std::filesystem::path& folder, Hold hold,
                       std::chrono::milliseconds most)
    : file_(folder / (hold == Hold::follow ? ranks_name : lock_name)) {
    Patience patience(folder, most);
    const int how = hold == Hold::lead ? LOCK_EX : LOCK_SH;
    while (true) {
        lock_.take(open_lock(file_, true));
        while (!try_lock(lock_.number(), how, file_)) patience.wait();
        if (same_file(lock_.number(), file_)) break;  // else it went with its folder meanwhile
        lock_.close();
        patience.wait();
    }
    if (hold != Hold::lead) return;
    wait_for_followers(folder, patience);
    write_mark(lock_.number(), file_);
}

void FolderLock::remove() {
    ::unlink((file_.parent_path() / ranks_name).c_str());
    ::unlink(file_.c_str());
}

bool is_marked(const std::filesystem::path& folder) {
    const Descriptor file(
        ::open((folder / lock_name).c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK));
    if (file.number() < 0) return false;
    std::array<char, mark.size()> text{};
    return ::read(file.number(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
           std::string_view(text.data(), text.size()) == mark;
}

}  // namespace vfplan
