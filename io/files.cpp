#include "io/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "kernels/error.h"

namespace vfplan {

std::string advice_on(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "the disk is full: free space there and run again";
        case EFBIG:
            return "no file may be so large here: raise the limit (ulimit -f) and run again";
        case EMFILE:
        case ENFILE:
            return "too many files are open: raise the limit (ulimit -n) and run again";
        case ENOMEM:
            return "there is not enough memory: free some and run again";
        default:
            return "check free space and permissions";
    }
}

void fail_on_file(const std::filesystem::path& file, const std::string& what, int error) {
    throw IoError(fmt::format("{}: cannot {}: {}; {}", file.string(), what, std::strerror(error),
                              advice_on(error)));
}

bool is_there(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::exists(std::filesystem::symlink_status(path, error));
}

void make_folders(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail_on_file(folder, "create", error.value());
}

std::string read_text(const std::filesystem::path& file) {
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    if (!in) fail_on_file(file, "open", errno);
    std::ostringstream out;
    out << in.rdbuf();
    if (in.bad()) fail_on_file(file, "read", errno);
    return out.str();
}

TextFile::TextFile(std::filesystem::path file)
    : file_(std::move(file)), aside_(file_), out_(aside_.create()) {}

TextFile::~TextFile() {
    if (out_ >= 0) ::close(out_);
}

void TextFile::add(const std::string& text) {
    for (std::size_t done = 0; done < text.size();) {
        const ssize_t n = ::write(out_, text.data() + done, text.size() - done);
        if (n < 0 && errno != EINTR) fail_on_file(file_, "write", errno);
        if (n > 0) done += static_cast<std::size_t>(n);
    }
}

void TextFile::close() {
    const int error = ::close(out_) == 0 ? 0 : errno;
    out_ = -1;
    if (error != 0) fail_on_file(file_, "write", error);
    aside_.publish();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    TextFile out(file);
    out.add(text);
    out.close();
}

}  // namespace vfplan
