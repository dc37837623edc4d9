// What a job has to hold in memory, whatever the site looks like, and whether there is so much.
#pragma once

#include <cstdint>

#include "engine/config/options.h"
#include "engine/runtime/memory.h"
#include "kernels/layout.h"

namespace vfplan {

// Throws UsageError when a process has to hold more at once than there is: only arrays of which the
// size is known are counted, so a job that is refused could not have been done. `plan`: the tables
// are not all.
void check_memory(const GroundOptions& options, const Layout& layout, std::int64_t pieces,
                  bool plan, const MemoryLimit& limit);

}  // namespace vfplan
