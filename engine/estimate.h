// What a job will take, for --dry-run.
#pragma once

#include <string>

#include "engine/config.h"
#include "engine/parallel.h"
#include "engine/progress.h"

namespace vfplan {

// Reads the site, makes nothing. Throws as make_site_store().
std::string estimate_text(const Config& config, const Threads& threads, Progress& progress);

}  // namespace vfplan
