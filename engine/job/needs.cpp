#include "engine/job/needs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "engine/tables/skeleton.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

double gb(double bytes) { return bytes / 1e9; }

// A number of two digits that is no less.
std::string at_least(double x) {
    const double digit = std::pow(10, std::floor(std::log10(x)) - 1);
    return fmt::format("{:.2g}", std::ceil(x / digit) * digit);
}

}  // namespace

void check_memory(const GroundOptions& o, const Layout& layout, std::int64_t pieces, bool plan,
                  const MemoryLimit& limit) {
    const auto refuse_above = [&](double bytes, const std::string& what,
                                  const std::string& change) {
        if (bytes <= limit.bytes) return;
        throw UsageError(fmt::format("{} in memory at once takes {:.3g} GB, and {} {:.3g} GB; {}",
                                     what, gb(bytes), limit.whose, gb(limit.bytes), change));
    };
    // Bytes of cells shrink with the square of their side.
    const auto side_for = [&](double bytes) {
        return at_least(o.cell_m * std::sqrt(bytes / limit.bytes));
    };

    // A bit for each cell.
    const auto cells = static_cast<double>(layout.grid.size());
    const double bits = cells / 8 + 24 * static_cast<double>(layout.patches());
    refuse_above(bits, fmt::format("field.cell_m = {}: {:.3g} cells", o.cell_m, cells),
                 fmt::format("take field.cell_m = {} or more, or site.crop_m", side_for(bits)));

    // The field of a patch: a float and a byte.
    const double patch = layout.largest_patch_cells();
    refuse_above(
        5 * patch,
        fmt::format("scanner.range_max_m = {}: the {:.3g} cells of {} m within six ranges",
                    o.range_max_m, patch, o.cell_m),
        fmt::format("take field.cell_m = {} or more, or a shorter range", side_for(5 * patch)));

    // A tile with a range around it, while its skeleton is found: field, domain, distance, state.
    const double window =
        layout.largest_window_cells(std::ceil(o.range_max_m / o.cell_m) + skeleton_margin_cells);
    refuse_above(
        18 * window,
        fmt::format("field.tile_cells = {}: a tile of {:.3g} cells with scanner.range_max_m = {} "
                    "around it",
                    layout.tile_cells, window, o.range_max_m),
        fmt::format("take field.cell_m = {} or more, smaller tiles or a shorter range",
                    side_for(18 * window)));

    // A length for each piece while a plan is made; before, a byte for what became of it.
    const double of_pieces = (plan ? 9.0 : 1.0) * static_cast<double>(pieces);
    refuse_above(of_pieces,
                 fmt::format("coverage.partition_m = {}: {} pieces of wall", o.partition_m, pieces),
                 fmt::format("take coverage.partition_m = {} or more, or site.crop_m",
                             at_least(o.partition_m * of_pieces / limit.bytes)));
}

}  // namespace vfplan
