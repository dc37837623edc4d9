// Sets of numbers as sorted lists, as sorted blocks of 64 bits and as a bit for each number.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/graphs/sparse.h"

namespace vfplan::bench {

inline std::uint64_t bit(std::int32_t n) {
    return std::uint64_t{1} << (static_cast<std::uint32_t>(n) % 64);
}

template <class F>
void each_bit(std::uint64_t bits, F&& f) {
    for (; bits != 0; bits &= bits - 1) f(std::countr_zero(bits));
}

// Blocks of all sets one after another; number and bits apart, so that a block is 12 bytes.
struct Blocks {
    std::vector<std::int64_t> begin = {0};
    std::vector<std::int32_t> word;
    std::vector<std::uint64_t> bits;

    explicit Blocks(const Sparse& lists) {
        for (std::int32_t i = 0; i < lists.size(); ++i) {
            for (const std::int32_t n : lists.of(i)) {
                const bool same = static_cast<std::int64_t>(word.size()) > begin.back();
                if (!same || word.back() != n / 64) {
                    word.push_back(n / 64);
                    bits.push_back(0);
                }
                bits.back() |= bit(n);
            }
            begin.push_back(static_cast<std::int64_t>(word.size()));
        }
    }
    // Calls f(word, bits).
    template <class F>
    void each(std::int32_t i, F&& f) const {
        for (auto b = idx(begin[idx(i)]); b < idx(begin[idx(i) + 1]); ++b) f(word[b], bits[b]);
    }
};

// Sets of one kind in all forms, and a state in the middle of a plan.
struct Sets {
    Sparse lists;
    Sparse listed_by;
    Blocks blocks;
    std::size_t words;
    std::vector<std::uint64_t> dense;  // empty where it would be large
    std::vector<double> length_m;
    std::vector<std::uint8_t> covered;  // about half of all
    std::vector<std::uint64_t> open_bits;
    std::vector<double> open_m;  // 0 where covered
    std::vector<std::uint64_t> signature;
    std::vector<std::uint64_t> all_there;
    std::vector<std::uint8_t> there;
    std::vector<std::int32_t> asked;                // sets whose domination is looked at
    std::vector<std::vector<std::int32_t>> ruined;  // stations that go and come again

    Sets(Sparse of, std::vector<double> lengths);

private:
    void start_plan();
};

// Of a site's main network. `table`: pieces by candidate; `network`: rows of its problem by
// candidate, before it is reduced, and `reduced`, after; `rows`: candidates by row, before. nullptr
// where the site's data are missing.
const Sets* sets(const std::string& site, const std::string& kind);

}  // namespace vfplan::bench
