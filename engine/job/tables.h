// The whole way from a site to its tables: field.h5 and coverage.h5.
#pragma once

#include <filesystem>
#include <string>

#include "engine/config/options.h"
#include "engine/tables/shards.h"
#include "io/tables/field_tiles.h"
#include "io/tables/ridge_shards.h"
#include "io/tables/site_store.h"

namespace vfplan {

// True when field.h5 and coverage.h5 are of this job and all their shards are there and whole. What
// is not is named in a warning; an index without all its shards is removed.
bool tables_complete(const std::filesystem::path& dir, const std::string& key, Progress& progress);

// Makes what is missing of field.h5 and coverage.h5 in a run directory, on all ranks together:
// every phase leaves shards, so an end at any instant loses little. Equal jobs give equal bytes;
// of the field's shards with equal tiles, of all else always. REQUIRES: work/site.h5. Throws Error.
void make_tables(const TableOptions& options, const std::filesystem::path& dir,
                 const std::string& key, const Threads& threads, const Ranks& ranks,
                 Progress& progress);

// Its parts: field.h5 of a field that is made,
void make_field_index(const TableJob& job, const SiteStore& site, const FieldTiles& field);
// and its second half, from ridges to coverage.h5.
void make_coverage_table(const TableJob& job, const SiteStore& site, const FieldTiles& field,
                         const RidgeTiles& ridges, const TableOptions& options);

}  // namespace vfplan
