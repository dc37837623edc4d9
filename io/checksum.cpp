#include "io/checksum.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>
#include <vector>

#include "io/sha256.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

constexpr const char* trailer_label = "\nvfplan sha256 ";
constexpr std::size_t trailer_size = 15 + 64 + 1;

}  // namespace

void damaged(const std::filesystem::path& path, const std::string& what) {
    throw IoError(
        fmt::format("{}: {}; the file is damaged or not one of ours, run the job again "
                    "and it is made anew",
                    path.string(), what));
}

bool add_checksum(const std::filesystem::path& path) {
    const std::string hash = sha256_of_file(path);
    std::ofstream out(path, std::ios::binary | std::ios::app);
    out << trailer_label << hash << "\n";
    out.flush();
    return static_cast<bool>(out);
}

std::string checked_hash(const std::filesystem::path& path) {
    // Once for each state of a file: shards are read many times.
    using State = std::tuple<dev_t, ino_t, off_t, time_t, long>;
    static std::mutex guard;
    static std::map<std::string, std::pair<State, std::string>> known;
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) {
        throw IoError(
            fmt::format("{}: no such file; is this the folder of a finished run?", path.string()));
    }
    if (!S_ISREG(status.st_mode)) {
        throw IoError(fmt::format(
            "{}: {}, and what belongs to a run lies in its folder; put the file itself there",
            path.string(), S_ISLNK(status.st_mode) ? "a symbolic link" : "no file"));
    }
    const State state{status.st_dev, status.st_ino, status.st_size, status.st_mtim.tv_sec,
                      status.st_mtim.tv_nsec};
    const auto size = static_cast<std::uintmax_t>(status.st_size);
    {
        const std::lock_guard lock(guard);
        const auto found = known.find(path.string());
        if (found != known.end() && found->second.first == state) return found->second.second;
    }
    if (::access(path.c_str(), R_OK) != 0) {
        throw IoError(fmt::format("{}: cannot be read: {}; check its permissions", path.string(),
                                  std::strerror(errno)));
    }
    if (size < trailer_size) damaged(path, "too short for a whole file");
    Sha256 hash;
    std::ifstream in(path, std::ios::binary);
    std::uintmax_t left = size - trailer_size;
    std::vector<char> buffer(1U << 20);
    while (left > 0 && in) {
        in.read(buffer.data(),
                static_cast<std::streamsize>(std::min<std::uintmax_t>(left, buffer.size())));
        hash.add(buffer.data(), static_cast<std::size_t>(in.gcount()));
        left -= static_cast<std::uintmax_t>(in.gcount());
    }
    std::string trailer(trailer_size, '\0');
    in.read(trailer.data(), static_cast<std::streamsize>(trailer_size));
    if (!in) damaged(path, "cannot be read to its end");
    const std::string label = trailer_label;
    if (trailer.compare(0, label.size(), label) != 0 || trailer.back() != '\n') {
        damaged(path, "cut short or overwritten");
    }
    const std::string said = trailer.substr(label.size(), 64);
    if (said != hash.hex()) damaged(path, "its content does not have the hash that it ends with");
    const std::lock_guard lock(guard);
    known[path.string()] = {state, said};
    return said;
}

}  // namespace vfplan
