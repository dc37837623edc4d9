#include "io/temporary_folder.h"

#include <fmt/format.h>
#include <stdlib.h>

#include "kernels/error.h"

namespace vfplan {

TemporaryFolder::TemporaryFolder(const std::string& name) {
    std::error_code error;
    std::filesystem::path base = std::filesystem::temp_directory_path(error);
    if (error) base = "/tmp";
    std::string whole = (base / (name + "-XXXXXX")).string();
    if (mkdtemp(whole.data()) == nullptr) {
        throw IoError(
            fmt::format("{}: the folder cannot be created; free space there or set TMPDIR", whole));
    }
    path_ = whole;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

}  // namespace vfplan
