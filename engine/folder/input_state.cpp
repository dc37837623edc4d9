#include "engine/folder/input_state.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>

#include "engine/config/parameters.h"
#include "io/formats/read_features.h"
#include "kernels/error.h"

namespace vfplan {

InputState::InputState(const Config& config) {
    for (const std::filesystem::path& path : existing_paths(config)) {
        const bool site = path == config.site.input;
        const auto files = input_files(path, site && config.site.allow_network);
        files_.insert(files_.end(), files.begin(), files.end());
    }
    for (const std::filesystem::path& file : files_) stamps_.push_back(stamp_of(file));
    sha256_ = input_sha256(files_);
}

InputState::Stamp InputState::stamp_of(const std::filesystem::path& file) {
    struct stat s {};
    if (::stat(file.c_str(), &s) != 0) return {};  // it is gone, or read through the network
    return {s.st_dev,          s.st_ino,         s.st_size,        s.st_mtim.tv_sec,
            s.st_mtim.tv_nsec, s.st_ctim.tv_sec, s.st_ctim.tv_nsec};
}

void InputState::check_unchanged() const {
    const auto fail = [](const std::string& what) {
        throw IoError(fmt::format(
            "{}: was changed while it was read; run again when nobody writes to it", what));
    };
    for (std::size_t i = 0; i < files_.size(); ++i) {
        if (stamp_of(files_[i]) != stamps_[i]) fail(files_[i].string());
    }
    if (std::any_of(files_.begin(), files_.end(), is_remote) && input_sha256(files_) != sha256_) {
        fail("the site, which is read through the network,");
    }
}

}  // namespace vfplan
