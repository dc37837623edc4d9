#include "kernels/skeleton.h"

#include <array>
#include <bit>
#include <cmath>
#include <queue>
#include <tuple>

#include "kernels/index.h"

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
// the corner of a block, three neighbours on one side: in a square's corner the cells go one
// after the other, and without this the first would go before its branch exists.
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

struct Around {
    unsigned present = 0;  // bit k: neighbour k
    unsigned unknown = 0;
};

Around around(const Grid& grid, const std::vector<Cell>& state, std::int64_t cell) {
    const std::int32_t ix = grid.ix(cell);
    const std::int32_t iy = grid.iy(cell);
    Around out;
    for (unsigned k = 0; k < 8; ++k) {
        const std::int32_t x = ix + around_dx[k];
        const std::int32_t y = iy + around_dy[k];
        if (!grid.inside(x, y)) continue;
        const Cell s = state[static_cast<std::size_t>(grid.id(x, y))];
        if (s == Cell::present) out.present |= 1U << k;
        if (s == Cell::unknown) out.unknown |= 1U << k;
    }
    return out;
}

enum class Fate { stays, goes, unclear };

class Thinning {
public:
    Thinning(const Grid& grid, const DistanceField& distance, const PartOfGrid& part,
             std::vector<Cell>& state)
        : grid_(grid), distance_(distance), part_(part), state_(state), waiting_(state.size(), 0) {}

    // With `corners`, the corners of blocks are kept as ends.
    void run(bool corners) {
        for (std::int64_t cell = 0; cell < grid_.size(); ++cell) {
            if (state_[idx(cell)] != Cell::present) continue;
            if (around(grid_, state_, cell).present != 255) wait(cell);
        }
        while (!later_.empty()) {
            level_ = level_of(later_.top());
            while (!later_.empty() && level_of(later_.top()) <= level_) {
                const std::int64_t cell = cell_of(later_.top());
                later_.pop();
                turn_[turn_of(cell)].push_back(cell);
            }
            rounds(corners);
        }
        level_ = -1;
    }

private:
    // Squared distance above, cell below: both fit 32 bits (a part has fewer than 2^32 cells).
    static std::int64_t level_of(std::uint64_t entry) {
        return static_cast<std::int64_t>(entry >> 32);
    }
    static std::int64_t cell_of(std::uint64_t entry) {
        return static_cast<std::int64_t>(entry & 0xffffffffU);
    }
    std::size_t turn_of(std::int64_t cell) const {
        const auto x = static_cast<unsigned>(grid_.ix(cell) + part_.x0);
        const auto y = static_cast<unsigned>(grid_.iy(cell) + part_.y0);
        return (x & 1U) | (y & 1U) << 1U;
    }

    void wait(std::int64_t cell) {
        if (waiting_[idx(cell)] != 0) return;
        waiting_[idx(cell)] = 1;
        const std::int64_t level = distance_.squared[idx(cell)];
        if (level <= level_) {
            turn_[turn_of(cell)].push_back(cell);
        } else {
            later_.push(static_cast<std::uint64_t>(level) << 32 | static_cast<std::uint64_t>(cell));
        }
    }

    void rounds(bool corners) {
        std::vector<std::int64_t> now;
        for (std::size_t idle = 0, t = 0; idle < turn_.size(); t = (t + 1) % turn_.size()) {
            now.clear();
            now.swap(turn_[t]);
            idle = now.empty() ? idle + 1 : 0;
            for (const std::int64_t cell : now) {
                waiting_[idx(cell)] = 0;
                const Around a = around(grid_, state_, cell);
                const Fate fate = fate_of(cell, a, corners);
                if (fate == Fate::stays) continue;
                state_[idx(cell)] = fate == Fate::goes ? Cell::absent : Cell::unknown;
                for (std::size_t k = 0; k < 8; ++k) {
                    if ((a.present >> k & 1U) == 0) continue;
                    wait(cell + around_dx[k] + around_dy[k] * std::int64_t{grid_.nx});
                }
            }
        }
    }

    // The same answer for all that the unknown neighbours may be, or unclear.
    Fate fate_of(std::int64_t cell, const Around& a, bool corners) const {
        static const std::array<bool, 256> simple = make_simple_table();
        int goes = 0;
        int stays = 0;
        int end = -1;  // whether the flux makes an end stay: not asked yet
        for (unsigned some = a.unknown;; some = (some - 1) & a.unknown) {
            const unsigned bits = a.present | some;
            bool keep = !simple[bits];
            if (!keep && is_end(bits, corners)) {
                if (end < 0) end = outward_flux(grid_, distance_, cell) < flux_of_an_end ? 1 : 0;
                keep = end == 1;
            }
            ++(keep ? stays : goes);
            if (some == 0) break;
        }
        if (goes == 0) return Fate::stays;
        return stays == 0 ? Fate::goes : Fate::unclear;
    }

    const Grid& grid_;
    const DistanceField& distance_;
    const PartOfGrid& part_;
    std::vector<Cell>& state_;
    std::vector<std::uint8_t> waiting_;  // once in a queue is enough
    std::int64_t level_ = -1;
    std::array<std::vector<std::int64_t>, 4> turn_;  // cells whose turn comes on this level
    std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> later_;
};

// Domain cells whose distance, or a neighbour's, may be less in the whole grid: something nearer
// may lie beyond an edge of the part.
std::vector<Cell> known_cells(const Grid& grid, const Raster<std::uint8_t>& domain,
                              const DistanceField& distance, const PartOfGrid& part) {
    const auto sure = [&](std::int32_t x, std::int32_t y) {
        const auto i = static_cast<std::size_t>(grid.id(x, y));
        if (domain[i] == 0) return true;
        const std::int32_t to_edge[4] = {x + 1, y + 1, grid.nx - x, grid.ny - y};
        for (std::size_t k = 0; k < 4; ++k) {
            if (!part.more[k]) continue;
            if (static_cast<std::int64_t>(to_edge[k]) * to_edge[k] <= distance.squared[i]) {
                return false;
            }
        }
        return true;
    };
    std::vector<Cell> state(domain.size(), Cell::absent);
    for (std::int32_t y = 0; y < grid.ny; ++y) {
        for (std::int32_t x = 0; x < grid.nx; ++x) {
            const auto i = static_cast<std::size_t>(grid.id(x, y));
            if (domain[i] == 0) continue;
            bool known = sure(x, y);
            for (std::size_t k = 0; k < 8 && known; ++k) {
                const std::int32_t nx = x + around_dx[k];
                const std::int32_t ny = y + around_dy[k];
                if (grid.inside(nx, ny)) {
                    known = sure(nx, ny);
                } else {
                    known = !((nx < 0 && part.more[0]) || (ny < 0 && part.more[1]) ||
                              (nx >= grid.nx && part.more[2]) || (ny >= grid.ny && part.more[3]));
                }
            }
            state[i] = known ? Cell::present : Cell::unknown;
        }
    }
    return state;
}

}  // namespace

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

std::vector<Cell> thin(const Grid& grid, const Raster<std::uint8_t>& domain,
                       const DistanceField& distance, const PartOfGrid& part) {
    std::vector<Cell> state = known_cells(grid, domain, distance, part);
    Thinning thinning(grid, distance, part, state);
    // First with corners kept, which leaves some lines two cells wide; then without.
    thinning.run(true);
    thinning.run(false);
    return state;
}

}  // namespace vfplan
