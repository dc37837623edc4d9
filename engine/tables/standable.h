// Where on a site's grid stations may stand: in free space, not forbidden, off the walls by the
// clearance.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/config/options.h"
#include "engine/runtime/parallel.h"
#include "kernels/layout.h"
#include "kernels/wall.h"

namespace vfplan {

// The border of where the user lets no station stand, in the site's frame; empty without any.
// Throws as read_features() does.
std::vector<Border> forbidden_border(const GroundOptions& options, const Site& site);

// The cells, a bit each, by patch. Works in patches, several at once where they are small: memory
// is four bytes for each cell of one, or of cells_at_once.
inline constexpr std::int64_t cells_at_once = 4'000'000;
std::vector<std::vector<std::uint8_t>> standable_bits(const GroundOptions& options,
                                                      const Site& site, const Layout& layout,
                                                      const Threads& threads);

struct FreeCells {
    std::int64_t count = 0;
    bool exact = true;
};
// How many they are: exactly on a grid of up to `looked_at_most` cells, else from windows with so
// many cells in all, spread over the grid.
FreeCells count_free_cells(const GroundOptions& options, const Site& site, const Grid& grid,
                           const Threads& threads, std::int64_t looked_at_most);

}  // namespace vfplan
