// From an input file to work/site.h5.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/config/options.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"
#include "io/site/site_reader.h"
#include "kernels/layout.h"

namespace vfplan {

// Phase "site": reads and checks the site and writes its store, on the leader alone, unless it is
// there. Throws as read_ground() and store_site().
void make_site(const GroundOptions& options, const std::filesystem::path& dir,
               const std::string& key, const Threads& threads, Progress& progress);

// --- its parts -----------------------------------------------------------------------------------

// Reads and checks the site. Notes what was cleaned. Throws UsageError when a point of the user
// lies where no station can stand; InputError; IoError.
Site read_ground(const GroundOptions& options, const Threads& threads, Progress& progress);

// The grid over a site, cut into patches and tiles. Throws UsageError when the cells do not fit the
// site.
Layout layout_of(const GroundOptions& options, const Site& site);

// Cells where a station may stand, a bit each, by patch: in free space, not forbidden, no wall
// nearer than the clearance. Works in bands of patches: memory is a band's.
std::vector<std::vector<std::uint8_t>> standable_bits(const GroundOptions& options,
                                                      const Site& site, const Layout& layout,
                                                      const Threads& threads);

// Writes the store of a site. Throws UsageError when no cell is free; IoError.
void store_site(const GroundOptions& options, const std::string& key, const Site& site,
                const Threads& threads, const std::filesystem::path& path);

}  // namespace vfplan
