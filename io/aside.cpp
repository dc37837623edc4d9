#include "io/aside.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "io/files.h"

namespace vfplan {
namespace {

// Names of what is in the making, for remove_asides(). Where there are more, a process that is
// ended by force leaves them, as a kill does, and the next one removes them.
constexpr std::size_t most = 512;
std::array<std::atomic<char*>, most> names;

std::size_t note(const std::filesystem::path& path) {
    char* name = ::strdup(path.c_str());
    if (name == nullptr) return 0;
    for (std::size_t i = 0; i < most; ++i) {
        char* none = nullptr;
        if (names[i].compare_exchange_strong(none, name)) return i + 1;
    }
    std::free(name);
    return 0;
}

void forget(std::size_t slot) noexcept {
    if (slot != 0) std::free(names[slot - 1].exchange(nullptr));
}

// What SQLite puts beside its file.
constexpr std::array beside_database = {"-journal", "-wal", "-shm"};

void sync(const std::filesystem::path& path, int flags) {
    const int fd = ::open(path.c_str(), flags | O_RDONLY | O_CLOEXEC);
    if (fd < 0) fail_on_file(path, "open", errno);
    const int error = ::fsync(fd) == 0 ? 0 : errno;
    ::close(fd);
    if (error != 0) fail_on_file(path, "sync", error);
}

}  // namespace

Aside::Aside(std::filesystem::path file, bool in_folder) : file_(std::move(file)), path_(file_) {
    path_ += ".tmp";
    if (in_folder) {
        folder_ = path_;
        path_ /= file_.filename();
    }
    remove();
    if (in_folder && ::mkdir(folder_.c_str(), 0700) != 0) fail_on_file(file_, "write", errno);
    slots_[0] = note(path_);
    if (!in_folder) return;
    std::size_t slot = 0;
    for (const char* beside : beside_database) {
        slots_[++slot] = note(path_.string() + beside);
    }
    slots_[++slot] = note(folder_);
}

Aside::~Aside() {
    if (!published_) remove();
    for (const std::size_t slot : slots_) forget(slot);
}

void Aside::remove() noexcept {
    ::unlink(path_.c_str());  // a link itself, not what it leads to
    if (folder_.empty()) return;
    for (const char* beside : beside_database) ::unlink((path_.string() + beside).c_str());
    if (::unlink(folder_.c_str()) != 0) ::rmdir(folder_.c_str());
}

int Aside::create() const {
    const int fd =
        ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (fd < 0) fail_on_file(file_, "write", errno);
    return fd;
}

void Aside::publish() {
    sync(path_, O_NOFOLLOW);
    if (::rename(path_.c_str(), file_.c_str()) != 0) {
        fail_on_file(file_, "rename into place", errno);
    }
    published_ = true;
    if (!folder_.empty()) ::rmdir(folder_.c_str());
    sync_folder(file_.has_parent_path() ? file_.parent_path() : std::filesystem::path("."));
}

void sync_folder(const std::filesystem::path& folder) { sync(folder, O_DIRECTORY); }

void remove_asides() noexcept {
    for (std::atomic<char*>& name : names) {
        const char* path = name.exchange(nullptr);
        if (path == nullptr) continue;
        if (::unlink(path) != 0) ::rmdir(path);
    }
}

}  // namespace vfplan
