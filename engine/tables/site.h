// From an input file to work/site.h5.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "engine/config/options.h"
#include "engine/runtime/parallel.h"
#include "engine/runtime/progress.h"
#include "engine/tables/narrow.h"
#include "io/site/site_reader.h"
#include "kernels/layout.h"

namespace vfplan {

// Phase "site": reads and checks the site and writes its store, on the leader alone, unless it is
// there. Between the two, `may_begin` may refuse the job; when all files were read and nothing is
// stored yet, `may_store`. Throws as read_ground() and store_site().
void make_site(const GroundOptions& options, const std::filesystem::path& dir,
               const std::string& key, const Threads& threads, Progress& progress,
               const std::function<void(const Site&, const Layout&)>& may_begin,
               const std::function<void()>& may_store);

// --- its parts -----------------------------------------------------------------------------------

// Reads and checks the site. Notes what was cleaned. Throws UsageError when a point of the user
// lies where no station can stand; InputError; IoError.
Site read_ground(const GroundOptions& options, const Threads& threads, Progress& progress);

// The grid over a site, cut into patches and tiles. Throws UsageError when the cells do not fit the
// site.
Layout layout_of(const GroundOptions& options, const Site& site);

// Throws UsageError when there is none.
void check_free_cells(const GroundOptions& options, std::int64_t free_cells);

// Writes the store of a site. `narrow`: for its summary. Throws UsageError when no cell is free,
// unless there `may_be_none`; IoError.
void store_site(const GroundOptions& options, const std::string& key, const Site& site,
                const std::vector<NarrowPlace>& narrow, const Threads& threads,
                const std::filesystem::path& path, bool may_be_none = false,
                const std::function<void()>& may_store = {});

}  // namespace vfplan
