// The visibility field (docs/method.md 2).
#pragma once

#include "engine/tables/shards.h"
#include "io/tables/field_tiles.h"
#include "io/tables/site_store.h"

namespace vfplan {

// What a tile holds while its field is made.
double field_task_bytes(const Layout& layout);

// Phase "field": shards/field-SIDE-NUMBER.h5.
FieldTiles make_field(const TableJob& job, const SiteStore& site);

}  // namespace vfplan
