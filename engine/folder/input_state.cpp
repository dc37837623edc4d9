#include "engine/folder/input_state.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>

#include "engine/config/parameters.h"
#include "io/formats/read_features.h"
#include "io/sha256.h"
#include "kernels/error.h"

namespace vfplan {

InputState::InputState(const Config& config) {
    for (const std::filesystem::path& path : existing_paths(config)) {
        if (std::filesystem::is_regular_file(path)) files_.push_back(path);
    }
    for (const std::filesystem::path& path : companions(config.site.input)) files_.push_back(path);
    stamps_ = stamps_of(files_);
    Sha256 whole;
    for (const std::filesystem::path& file : files_) whole.add(sha256_of_file(file));
    sha256_ = whole.hex();
}

std::vector<InputState::Stamp> InputState::stamps_of(
    const std::vector<std::filesystem::path>& files) {
    std::vector<Stamp> out;
    for (const std::filesystem::path& file : files) {
        struct stat s {};
        ::stat(file.c_str(), &s);  // of one that is gone, all is 0
        out.emplace_back(file, s.st_dev, s.st_ino, s.st_size, s.st_mtim.tv_sec, s.st_mtim.tv_nsec,
                         s.st_ctim.tv_sec, s.st_ctim.tv_nsec);
    }
    return out;
}

void InputState::check_unchanged() const {
    const std::vector<Stamp> now = stamps_of(files_);
    const auto [was, is] = std::mismatch(stamps_.begin(), stamps_.end(), now.begin());
    if (was == stamps_.end()) return;
    throw IoError(
        fmt::format("{}: was changed while it was read; run again when nobody writes to it",
                    std::get<0>(*was).string()));
}

}  // namespace vfplan
