// What the phases that find candidates hand on, tile by tile: cells with their kind, and the pieces
// that they cover.
//
// A row costs some twenty microseconds and a county's rows are gigabytes, so no phase keeps rows:
// it keeps which pieces they cover, and looks again where it needs more.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/tables/shard.h"
#include "kernels/candidate.h"

namespace vfplan {

struct FoundCandidate {
    std::int64_t cell = -1;
    CandidateKind kind = CandidateKind::joint;
};

// work/.../joints-TILE.h5, splits-TILE.h5.
struct FoundTile {
    std::vector<FoundCandidate> candidates;
    std::vector<std::int32_t> covered;  // pieces, ascending
    std::int64_t short_of_overlap =
        0;  // arcs of ridges that are split as far as it goes and still below
};
void write_found_tile(const std::filesystem::path& path, const std::string& key,
                      const FoundTile& tile);

// Thread-safe. Throws IoError.
class FoundTiles {
public:
    FoundTiles(ShardNames names, std::int64_t tiles) : names_(std::move(names)), tiles_(tiles) {}

    // Of all tiles, tile by tile.
    std::vector<FoundCandidate> candidates() const;
    // Sets the bit of each piece that some tile covers.
    void mark_covered(std::vector<bool>& pieces) const;
    std::int64_t short_of_overlap() const;

private:
    ShardNames names_;
    std::int64_t tiles_;
};

// Cells and which pieces each of them covers, ascending.
struct CellRows {
    std::vector<std::int64_t> cell;
    std::vector<std::vector<std::int32_t>> covers;
};
// work/.../points-ROUND-NUMBER.h5: points off the ridges, square by square.
struct PoolSquare {
    CellRows taken;  // these become candidates
    CellRows again;  // these may be looked at again in the next round
};
void write_pool_squares(const std::filesystem::path& path, const std::string& key,
                        const std::vector<PoolSquare>& squares);
std::vector<PoolSquare> read_pool_squares(const std::filesystem::path& path);
// Of all squares together.
CellRows read_taken(const std::filesystem::path& path);

// work/.../weights-ROUND.h5: what each piece weighs.
void write_weights(const std::filesystem::path& path, const std::string& key,
                   const std::vector<std::int64_t>& weight);
std::vector<std::int64_t> read_weights(const std::filesystem::path& path);

// work/.../rescues-TILE.h5: pieces that nothing else covers, each with the best cell that sees
// enough of it, and which such pieces each of these cells covers.
struct RescueTile {
    static constexpr std::int64_t none = -1;     // no cell sees enough
    static constexpr std::int64_t rescued = -2;  // the cell of a piece before covers it

    std::vector<std::int32_t> piece;       // ascending
    std::vector<std::int64_t> piece_cell;  // of each: a cell, none or rescued
    CellRows cells;                        // each once, ascending, with such pieces
};
void write_rescue_tile(const std::filesystem::path& path, const std::string& key,
                       const RescueTile& tile);
RescueTile read_rescue_tile(const std::filesystem::path& path);

}  // namespace vfplan
