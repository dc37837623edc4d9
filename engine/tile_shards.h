// What the phases of candidates hand on: cells with their kind, and the pieces that they cover.
#pragma once

#include <initializer_list>

#include "engine/candidate_tiles.h"
#include "engine/work.h"

namespace vfplan {

struct TileCandidate {
    std::int64_t cell = -1;
    CandidateKind kind = CandidateKind::joint;
};

void write_tile_candidates(const Work& work, const std::filesystem::path& path,
                           const std::vector<TileCandidate>& candidates,
                           const std::vector<std::int32_t>& covered, std::int64_t falls_short);
std::vector<TileCandidate> read_tile_candidates(const std::filesystem::path& path);

// The pieces that some cells and points cover, ascending.
std::vector<std::int32_t> covered_from(const Work& work,
                                       const std::vector<TileCandidate>& candidates,
                                       const std::vector<Vec2d>& points);

// All pieces that the shards of these phases cover: one bit for each piece of the site.
CoveredPieces covered_pieces(const Work& work, std::initializer_list<const char*> phases);

}  // namespace vfplan
