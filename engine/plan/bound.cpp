#include "engine/plan/bound.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "kernels/index.h"

namespace vfplan {

std::vector<std::int32_t> independent_pieces(const OverlapRows& rows, const PieceIndex& index) {
    const auto viewers = [&](std::int32_t p) { return index.rows_of(p).size(); };
    // Fewest viewers first, then by number: counted, not sorted.
    std::vector<std::int64_t> begin(idx(rows.size()) + 2, 0);
    for (std::int32_t p = 0; p < index.pieces(); ++p) ++begin[viewers(p) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::int32_t> order(idx(index.pieces()));
    for (std::int32_t p = 0; p < index.pieces(); ++p) order[idx(begin[viewers(p)]++)] = p;
    std::vector<std::uint8_t> used(idx(rows.size()), 0);
    std::vector<std::int32_t> out;
    for (const std::int32_t p : order) {
        const std::span<const std::int32_t> by = index.rows_of(p);
        if (by.empty() ||
            std::any_of(by.begin(), by.end(), [&](std::int32_t c) { return used[idx(c)] != 0; })) {
            continue;
        }
        for (const std::int32_t c : by) used[idx(c)] = 1;
        out.push_back(p);
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace vfplan
