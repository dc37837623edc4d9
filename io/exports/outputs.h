// What a plan is handed out as: one table for who writes the files, removes them, foretells them
// and explains them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/names.h"

namespace vfplan {

class FieldFile;
struct CoverageTables;
struct Plan;

// Which pieces are handed out: in plan.h5 the status of every one is told.
enum class PieceList : std::uint8_t { automatic, all, uncovered };
template <>
struct Names<PieceList> {
    static constexpr std::array<std::string_view, 3> all = {"auto", "all", "uncovered"};
};
// By `automatic` all, unless there are more: lists of a county would have gigabytes, and no program
// shows them.
inline constexpr std::int64_t pieces_listed_most = 1'000'000;
inline bool lists_all(PieceList list, std::int64_t pieces) {
    return list == PieceList::all || (list == PieceList::automatic && pieces <= pieces_listed_most);
}

// A loop over blocks 0 to n - 1, by several threads perhaps.
using EachBlock =
    std::function<void(std::int64_t n, const std::function<void(std::int64_t block)>& body)>;

// What the files are made of; refers to what outlives it.
struct Results {
    const FieldFile& field;
    const CoverageTables& tables;
    const Plan& plan;
    std::string title;     // of the map, one line: the site
    std::string subtitle;  // one line: what the plan reached
    int map_px = 1600;
    bool all_pieces = true;  // false: only those that the main network does not cover
    EachBlock each_block;
};

// What a file takes, as it turned out on real sites (docs/performance.md).
struct OutputCost {
    double fixed = 0;
    double per_piece = 0;
    double per_candidate = 0;
    double per_pixel = 0;  // of the map, squared side

    double of(double pieces, double candidates, double pixels) const {
        return fixed + per_piece * pieces + per_candidate * candidates + per_pixel * pixels;
    }
};

struct Output {
    std::string_view format;  // as in output.formats
    std::string_view file;    // in the run directory
    // Whole or not at all; equal plans give equal bytes. Throws IoError.
    void (*write)(const std::filesystem::path& path, const Results& results);
    OutputCost bytes;
    OutputCost seconds;
    OutputCost memory_bytes;
};

// In the order in which they are written.
const std::vector<Output>& outputs();
// Whether `format` is among those that are asked for.
bool is_asked(const std::vector<std::string>& formats, std::string_view format);
// Each format once.
std::vector<std::string> output_formats();

}  // namespace vfplan
