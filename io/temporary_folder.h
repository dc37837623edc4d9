// A folder for temporary files that goes with its object, and all in it.
#pragma once

#include <filesystem>
#include <string>

namespace vfplan {

class TemporaryFolder {
public:
    // `name`: what its own name begins with. Throws IoError.
    explicit TemporaryFolder(const std::string& name);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

}  // namespace vfplan
