#include "kernels/skeleton.h"

#include <array>
#include <bit>
#include <cmath>
#include <queue>
#include <tuple>

namespace vfplan {
namespace {

// A cell may go without changing topology (foreground 8-connected, background 4-connected) when
// its foreground neighbours are one 8-connected group and the background touches it by an edge:
// Hilditch's crossing number is one.
std::array<bool, 256> make_simple_table() {
    std::array<bool, 256> simple{};
    for (unsigned bits = 0; bits < 256; ++bits) {
        int crossings = 0;
        for (unsigned k = 0; k < 8; k += 2) {
            const bool here = (bits >> k & 1U) != 0;
            const bool diagonal = (bits >> (k + 1) & 1U) != 0;
            const bool next = (bits >> ((k + 2) % 8) & 1U) != 0;
            if (!here && (diagonal || next)) ++crossings;
        }
        simple[bits] = crossings == 1;
    }
    return simple;
}

// The end of a line: one neighbour, or two that touch each other by an edge. With `corners` also
// the corner of a block, three neighbours on one side: in a square's corner the cells go in order
// of row and column, and without this the first corner would go before its branch exists.
bool is_end(unsigned bits, bool corners) {
    const int count = std::popcount(bits);
    if (count == 1) return true;
    if (count == 3 && corners) {
        for (unsigned k = 0; k < 8; k += 2) {
            if (bits == (1U << k | 1U << (k + 1) | 1U << ((k + 2) % 8))) return true;
        }
    }
    if (count != 2) return false;
    for (unsigned k = 0; k < 8; ++k) {
        if (bits == (1U << k | 1U << ((k + 1) % 8))) return true;
    }
    return false;
}

}  // namespace

unsigned neighbourhood(const Grid& grid, const Raster<std::uint8_t>& set, std::int64_t cell) {
    const std::int32_t ix = grid.ix(cell);
    const std::int32_t iy = grid.iy(cell);
    unsigned bits = 0;
    if (ix > 0 && iy > 0 && ix + 1 < grid.nx && iy + 1 < grid.ny) {
        const std::int64_t up = grid.nx;
        const std::array<std::int64_t, 8> step = {1, up + 1, up, up - 1, -1, -up - 1, -up, 1 - up};
        for (unsigned k = 0; k < 8; ++k) {
            if (set[static_cast<std::size_t>(cell + step[k])] != 0) bits |= 1U << k;
        }
        return bits;
    }
    for (unsigned k = 0; k < 8; ++k) {
        const std::int32_t x = ix + around_dx[k];
        const std::int32_t y = iy + around_dy[k];
        if (grid.inside(x, y) && set[static_cast<std::size_t>(grid.id(x, y))] != 0) bits |= 1U << k;
    }
    return bits;
}

double outward_flux(const Grid& grid, const DistanceField& distance, std::int64_t cell) {
    const std::int32_t ix = grid.ix(cell);
    const std::int32_t iy = grid.iy(cell);
    double flux = 0;
    for (std::size_t k = 0; k < 8; ++k) {
        const std::int32_t x = ix + around_dx[k];
        const std::int32_t y = iy + around_dy[k];
        if (!grid.inside(x, y)) continue;
        const auto n = static_cast<std::size_t>(grid.id(x, y));
        if (distance.squared[n] == 0) continue;
        const double length = std::sqrt(static_cast<double>(distance.squared[n]));
        const double outward = k % 2 == 0 ? 1.0 : std::sqrt(0.5);
        flux -= outward *
                (around_dx[k] * distance.nearest_dx[n] + around_dy[k] * distance.nearest_dy[n]) /
                length;
    }
    return flux / 8;
}

Raster<std::uint8_t> thin(const Grid& grid, const Raster<std::uint8_t>& domain,
                          const DistanceField& distance) {
    static const std::array<bool, 256> simple = make_simple_table();
    Raster<std::uint8_t> left_over = domain;
    // Squared distance above, cell below: both fit 32 bits (see prepare()).
    std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> queue;
    Raster<std::uint8_t> waiting(domain.size(), 0);  // once in the queue is enough
    const auto wait = [&](std::int64_t cell) {
        const auto i = static_cast<std::size_t>(cell);
        if (waiting[i] != 0) return;
        waiting[i] = 1;
        queue.push(static_cast<std::uint64_t>(distance.squared[i]) << 32 |
                   static_cast<std::uint64_t>(cell));
    };
    // First with corners kept, which leaves some lines two cells wide; then without.
    for (const bool corners : {true, false}) {
        for (std::int64_t cell = 0; cell < grid.size(); ++cell) {
            if (left_over[static_cast<std::size_t>(cell)] == 0) continue;
            if (neighbourhood(grid, left_over, cell) != 255) wait(cell);
        }
        while (!queue.empty()) {
            const auto cell = static_cast<std::int64_t>(queue.top() & 0xffffffffU);
            queue.pop();
            const auto i = static_cast<std::size_t>(cell);
            waiting[i] = 0;
            if (left_over[i] == 0) continue;
            const unsigned bits = neighbourhood(grid, left_over, cell);
            if (!simple[bits]) continue;
            if (is_end(bits, corners) && outward_flux(grid, distance, cell) < flux_of_an_end) {
                continue;
            }
            left_over[i] = 0;
            for (std::size_t k = 0; k < 8; ++k) {
                if ((bits >> k & 1U) != 0)
                    wait(cell + around_dx[k] + around_dy[k] * std::int64_t{grid.nx});
            }
        }
    }
    return left_over;
}

}  // namespace vfplan
