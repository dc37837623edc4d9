#include "engine/tables/covered.h"

#include <algorithm>
#include <bit>

#include "kernels/index.h"

namespace vfplan {

std::vector<std::int32_t> covered_from(const TableJob& job, const std::vector<Vec2d>& eyes,
                                       std::int64_t pieces) {
    constexpr std::size_t at_once = 512;
    std::vector<std::uint64_t> bits(idx(pieces) / 64 + 1, 0);
    for (std::size_t from = 0; from < eyes.size(); from += at_once) {
        const std::vector<Vec2d> some(
            eyes.begin() + static_cast<std::ptrdiff_t>(from),
            eyes.begin() + static_cast<std::ptrdiff_t>(std::min(eyes.size(), from + at_once)));
        std::vector<std::vector<std::int32_t>> rows(some.size());
        job.scenes.each(job.threads, some, [&](std::size_t i, const Scene& scene) {
            rows[i] = scene.covered(some[i]);
        });
        for (const std::vector<std::int32_t>& row : rows) {
            for (const std::int32_t p : row) bits[idx(p) / 64] |= 1ULL << idx(p) % 64;
        }
    }
    std::vector<std::int32_t> out;
    for (std::size_t word = 0; word < bits.size(); ++word) {
        for (std::uint64_t left = bits[word]; left != 0; left &= left - 1) {
            out.push_back(static_cast<std::int32_t>(64 * word) + std::countr_zero(left));
        }
    }
    return out;
}

std::vector<Vec2d> centres(const Grid& grid, const std::vector<std::int64_t>& cells) {
    std::vector<Vec2d> out;
    out.reserve(cells.size());
    for (const std::int64_t c : cells) out.push_back(grid.centre(c));
    return out;
}

}  // namespace vfplan
