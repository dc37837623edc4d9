// What is between tables while networks are joined over all free cells (docs/method.md 6): in which
// set each piece is seen, which cells see pieces of several sets, and how far sets are apart.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/h5_reader.h"
#include "io/tables/shard.h"
#include "kernels/overlap.h"

namespace vfplan {

// Who sees a piece, of candidates and of cells looked from by then.
enum class PieceRole : std::uint8_t {
    settled,  // in a space that one set has for itself: nobody asks further
    unseen,   // nobody
    lesser,   // one set, which is not the largest of the piece's space
    largest,  // the largest set of the space
    shared,   // several sets; all cells that may see it have been looked from
    look,     // several sets, or one and nobody a round ago: cells that may see it are to be
};

// work/.../disputed-ROUND.h5: where a round begins.
struct DisputeRound {
    bool open = false;        // false: nothing is left to look at
    std::int64_t spaces = 0;  // that candidates see anything of, each closed off by walls
    std::vector<PieceRole> role;
    // That sees it; of an unseen piece the largest of its space, of one to look for -1.
    std::vector<std::int32_t> set;
};
void write_dispute_round(const std::filesystem::path& path, const std::string& key,
                         const DisputeRound& round);
DisputeRound read_dispute_round(const std::filesystem::path& path);

// work/.../disputed-ROUND-TILE.h5: cells that see what no one set has for itself, ascending.
void write_disputed_cells(const std::filesystem::path& path, const std::string& key,
                          const std::vector<std::int64_t>& cells);
std::vector<std::int64_t> read_disputed_cells(const std::filesystem::path& path);

// Two sets, and the most that a place of one overlaps with a place of the other.
struct SetPair {
    std::int32_t a = 0;
    std::int32_t b = 0;
    double overlap = 0;
};

// Between the components of the overlap graph over all free cells. A component is named by one of
// its candidates; one without any by a number behind the last candidate.
struct Apart {
    std::int64_t free_cells = 0;      // over which the pairs are the largest overlaps; 0: not known
    std::int64_t disputed_cells = 0;  // so many of them, of different rows, see what several do
    OverlapRule rule;                 // the components are by it, and the overlaps
    std::vector<SetPair> pairs;       // those that share a piece
};
// Group `apart` of a file, where it is known.
void write_apart(h5::Writer& file, const Apart& apart);
Apart read_apart(const h5::Reader& file);
// work/.../apart.h5.
void write_apart(const std::filesystem::path& path, const std::string& key, const Apart& apart);
Apart read_apart(const std::filesystem::path& path);

}  // namespace vfplan
