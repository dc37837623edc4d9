#include "io/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "kernels/error.h"

namespace vfplan {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
    throw IoError(fmt::format("{}: cannot {}: {}; check free space and permissions", file.string(),
                              what, std::strerror(errno)));
}

void sync(const std::filesystem::path& file, int flags) {
    const int fd = ::open(file.c_str(), flags);
    if (fd < 0) fail(file, "open");
    const bool good = ::fsync(fd) == 0;
    ::close(fd);
    if (!good) fail(file, "sync");
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) fail(file, "open");
    std::ostringstream out;
    out << in.rdbuf();
    if (in.bad()) fail(file, "read");
    return out.str();
}

TextFile::TextFile(std::filesystem::path file) : file_(std::move(file)), aside_(file_) {
    aside_ += ".tmp";
    out_.open(aside_, std::ios::binary | std::ios::trunc);
    if (!out_) fail(file_, "write");
}

TextFile::~TextFile() {
    if (!out_.is_open()) return;
    out_.close();
    std::error_code ignored;
    std::filesystem::remove(aside_, ignored);
}

void TextFile::add(const std::string& text) {
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (!out_) fail(file_, "write");
}

void TextFile::close() {
    out_.flush();
    if (!out_) fail(file_, "write");
    out_.close();
    publish(aside_, file_);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
    TextFile out(file);
    out.add(text);
    out.close();
}

void publish(const std::filesystem::path& aside, const std::filesystem::path& file) {
    sync(aside, O_RDONLY);
    std::error_code error;
    std::filesystem::rename(aside, file, error);
    if (error) {
        errno = error.value();
        fail(file, "rename into place");
    }
    const auto folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
    sync(folder, O_RDONLY | O_DIRECTORY);
}

}  // namespace vfplan
