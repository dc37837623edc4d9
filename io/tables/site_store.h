// work/site.h5: a cleaned site, laid out so that any patch can be read without the rest.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/h5_reader.h"
#include "kernels/coverage.h"
#include "kernels/layout.h"
#include "kernels/wall.h"

namespace vfplan {

// Where it lies in a run directory.
std::filesystem::path site_store_path(const std::filesystem::path& dir);

// The cells of a patch where a station may stand, a bit each, row by row.
using CellBits = std::vector<std::uint8_t>;

// What the rest of a job needs to know of the whole site.
struct SiteFacts {
    Vec2d origin{0, 0};  // site frame to input coordinates
    std::string crs_wkt;
    std::string summary;  // JSON text for summary.json
    std::int64_t buildings = 0;
    std::int64_t walls = 0;
    std::int64_t pieces = 0;
    std::int64_t free_cells = 0;
    Box extent;
    std::vector<Vec2d> required;  // the user's points, in the site's frame
    std::vector<Vec2d> existing;
};

// A patch: the walls in and around it in the site's frame, ascending, and where their pieces begin
// in the site's numbering (left and right side; -1 where none).
struct PatchSite {
    std::vector<std::int32_t> number;  // of each wall
    std::vector<Wall> walls;
    std::vector<std::int32_t> first[2];
    std::vector<std::int32_t> count;  // pieces on each of the sides that have any
};

// Writes the store. `free_bits`: by patch. Throws IoError.
void write_site_store(const std::filesystem::path& path, const std::string& key,
                      const Layout& layout, const SiteFacts& facts, const std::vector<Wall>& walls,
                      const Pieces& pieces, const NearWalls& near,
                      const std::vector<CellBits>& free_bits);

// Reads it, patch by patch. Thread-safe. Throws IoError.
class SiteStore {
public:
    // Tiles may be of another size than those it was written for.
    SiteStore(const std::filesystem::path& path, std::int64_t tile_cells);

    const Layout& layout() const { return layout_; }
    const SiteFacts& facts() const { return facts_; }
    bool has_walls(std::int64_t patch) const;
    PatchSite patch(std::int64_t patch) const;
    // 1 for each cell of the patch's window where a station may stand.
    Raster<std::uint8_t> standable(std::int64_t patch) const;
    // The same for any window of the grid.
    Raster<std::uint8_t> standable(const Window& window) const;
    // All walls of the site, for tables and pictures.
    std::vector<Wall> all_walls() const;
    Pieces all_pieces(const std::vector<Wall>& walls) const;

private:
    h5::Reader file_;
    Layout layout_;
    SiteFacts facts_;
    std::vector<std::int64_t> wall_begin_;
    std::vector<std::int64_t> bits_begin_;
};

}  // namespace vfplan
