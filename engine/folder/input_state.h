// What a job reads, and whether it is still what it was.
#pragma once

#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include "engine/config/config.h"

namespace vfplan {

// The content of every file that the paths of a configuration lead to, hashed when the object is
// made, and what the system says of each: which file it is, and when anything of it changed last.
class InputState {
public:
    // Throws IoError when a path leads nowhere or a file cannot be read, InputError for what cannot
    // be hashed.
    explicit InputState(const Config& config);

    const std::string& sha256() const { return sha256_; }

    // Throws IoError when a file is another than it was, or was touched: what was read since need
    // not be what was hashed.
    void check_unchanged() const;

private:
    using Stamp = std::tuple<unsigned long, unsigned long, long, long, long, long, long>;
    static Stamp stamp_of(const std::filesystem::path& file);

    std::vector<std::filesystem::path> files_;
    std::vector<Stamp> stamps_;
    std::string sha256_;
};

}  // namespace vfplan
