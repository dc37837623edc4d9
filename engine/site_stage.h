// From an input file to work/site.h5.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/config.h"
#include "engine/parallel.h"
#include "engine/progress.h"
#include "io/site_reader.h"
#include "kernels/layout.h"

namespace vfplan {

SiteOptions site_options(const Config& config);

// The grid over a site, cut into patches and tiles. Throws UsageError when the cells do not fit the
// site.
Layout layout_of(const Config& config, const Site& site);

// Cells where a station may stand, a bit each, by patch: in free space, not forbidden, no wall
// nearer than the clearance. Works in bands of patches: memory is a band's.
std::vector<std::vector<std::uint8_t>> standable_bits(const Config& config, const Site& site,
                                                      const Layout& layout, const Threads& threads);

// Reads and checks the site. Notes what was cleaned. Throws UsageError when a point of the user
// lies where no station can stand; InputError; IoError.
Site read_job_site(const Config& config, const Threads& threads, Progress& progress);

// Writes the store of a site. Throws UsageError when no cell is free; IoError.
void store_site(const Config& config, const std::string& key, const Site& site,
                const Threads& threads, const std::filesystem::path& path);

// One line for people.
std::string site_text(const Site& site);

}  // namespace vfplan
