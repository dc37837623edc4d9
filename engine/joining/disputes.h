// The free cells that networks could be joined over (docs/method.md 6), block by block.
#pragma once

#include <vector>

#include "engine/tables/shards.h"
#include "io/tables/field_tiles.h"
#include "io/tables/join_shards.h"
#include "io/tables/site_store.h"
#include "kernels/overlap.h"

namespace vfplan {

// The grid in blocks. Around each, pieces and cells are looked at as far as two views reach; where
// cells are small that is many tiles, and a block is as large.
Layout dispute_blocks(const TableJob& job);

// Phase "disputed": work/.../disputed-ROUND-NUMBER.h5, the block's free cells whose rows hold a
// piece that several sets see or none, or pieces of two sets; of cells with equal rows the first,
// where overlap goes by length. All other cells see pieces of one set only, and no other set sees
// these: they join nothing.
//  (1) looked from are only cells that may see such pieces, by the weak visibility of pieces
//      (kernels/weak_view.h), and of these none is left out
//  (2) in rounds after the first only pieces of which something changed are asked about
//  (3) cells of the rounds before are not named again
// `rounds`: their shards, and behind them those of this round.
void make_disputed(const TableJob& job, const std::vector<ShardNames>& rounds,
                   const SiteStore& site, const FieldTiles& field, const DisputeRound& round,
                   const OverlapRule& rule);

}  // namespace vfplan
