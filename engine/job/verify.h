// verify DIR: a finished run looked at again.
#pragma once

#include <filesystem>
#include <string>

#include "engine/runtime/progress.h"

namespace vfplan {

struct VerifyResult {
    bool good = false;
    std::string text;  // one line per check
};

// Views, coverage and connection of the stations anew with the exact kernel, and the views once
// more with rays; a sample of the field; the certificate of the bound. Throws IoError for a folder
// that cannot be read.
VerifyResult verify_run(const std::filesystem::path& dir, int threads, Progress& progress);

}  // namespace vfplan
