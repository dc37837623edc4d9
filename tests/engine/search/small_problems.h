// Problems small enough to try every choice.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <random>
#include <vector>

#include "engine/search/problem.h"

namespace vfplan::test {

// Connected; some rows and columns repeat or hold others, some columns are fixed.
inline Problem random_problem(std::uint64_t seed, std::int32_t columns, std::int32_t rows,
                              bool fixed) {
    std::mt19937_64 random(seed);
    const auto chance = [&](std::uint64_t one_in) { return random() % one_in == 0; };
    const std::uint64_t sparse = 2 + random() % 5;
    const std::uint64_t far = 2 + random() % 6;
    std::vector<std::vector<std::int32_t>> near(idx(columns));
    for (std::int32_t b = 1; b < columns; ++b) {
        const auto a = static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(b));
        for (std::int32_t k = 0; k < b; ++k) {
            if (k != a && !chance(far)) continue;
            near[idx(k)].push_back(b);
            near[idx(b)].push_back(k);
        }
    }
    Problem p;
    for (std::int32_t r = 0; r < rows; ++r) {
        const auto sure = static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(columns));
        for (std::int32_t c = 0; c < columns; ++c) {
            if (c == sure || chance(sparse)) p.columns_of.to.push_back(c);
        }
        p.columns_of.end_list();
    }
    p.rows_of = transposed(p.columns_of, columns);
    for (auto& list : near) {
        std::sort(list.begin(), list.end());
        p.near.to.insert(p.near.to.end(), list.begin(), list.end());
        p.near.end_list();
        p.fixed.push_back(fixed && chance(8) ? 1 : 0);
    }
    return p;
}

inline Choice choice_of(std::uint32_t bits) {
    Choice out;
    for (; bits != 0; bits &= bits - 1) out.push_back(std::countr_zero(bits));
    return out;
}

// Calls f(choice) for every plan there is.
template <class F>
void every_plan(const Problem& p, F&& f) {
    for (std::uint32_t bits = 1; bits < std::uint32_t{1} << p.columns(); ++bits) {
        const Choice choice = choice_of(bits);
        if (is_plan(p, choice)) f(choice);
    }
}

inline std::size_t fewest(const Problem& p) {
    std::size_t best = idx(p.columns()) + 1;
    every_plan(p, [&](const Choice& c) { best = std::min(best, c.size()); });
    return best;
}

// True if a chosen column is on a cycle of chosen ones: it can leave one of its links and be
// reached from the other end of it all the same.
inline bool on_cycle(const Problem& p, const Choice& choice, std::int32_t column) {
    std::vector<std::uint8_t> chosen(idx(p.columns()), 0);
    for (const std::int32_t c : choice) chosen[idx(c)] = 1;
    for (const std::int32_t first : p.near.of(column)) {
        if (chosen[idx(first)] == 0) continue;
        std::vector<std::uint8_t> seen(chosen.size(), 0);
        std::vector<std::int32_t> queue = {first};
        seen[idx(first)] = 1;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const std::int32_t n : p.near.of(queue[i])) {
                if (queue[i] == first && n == column) continue;
                if (n == column) return true;
                if (chosen[idx(n)] == 0 || seen[idx(n)] != 0) continue;
                seen[idx(n)] = 1;
                queue.push_back(n);
            }
        }
    }
    return false;
}

// How many chosen columns are on no cycle, though one of their links could be.
inline std::int64_t off_cycles(const Problem& p, const Choice& choice) {
    std::int64_t count = 0;
    for (const std::int32_t c : choice) {
        if (on_cycle(p, choice, c)) continue;
        const auto near = p.near.of(c);
        if (std::any_of(choice.begin(), choice.end(), [&](std::int32_t n) {
                return p.block[idx(n)] == p.block[idx(c)] &&
                       std::find(near.begin(), near.end(), n) != near.end();
            })) {
            ++count;
        }
    }
    return count;
}

// Cycles count from now on. Two columns are in one block if no loss of one link parts them.
inline void count_cycles(Problem& p) {
    const auto reached = [&](std::int32_t from, std::int32_t a, std::int32_t b) {
        std::vector<std::uint8_t> seen(idx(p.columns()), 0);
        std::vector<std::int32_t> queue = {from};
        seen[idx(from)] = 1;
        for (std::size_t i = 0; i < queue.size(); ++i) {
            for (const std::int32_t n : p.near.of(queue[i])) {
                const bool lost = (queue[i] == a && n == b) || (queue[i] == b && n == a);
                if (lost || seen[idx(n)] != 0) continue;
                seen[idx(n)] = 1;
                queue.push_back(n);
            }
        }
        return seen;
    };
    p.loose.assign(idx(p.columns()), 1);
    for (std::int32_t c = 0; c < p.columns(); ++c) {
        std::vector<std::uint8_t> together(idx(p.columns()), 1);
        for (std::int32_t a = 0; a < p.columns(); ++a) {
            for (const std::int32_t b : p.near.of(a)) {
                const auto seen = reached(c, a, b);
                for (std::size_t i = 0; i < seen.size(); ++i) together[i] &= seen[i];
            }
        }
        p.block.push_back(static_cast<std::int32_t>(std::find(together.begin(), together.end(), 1) -
                                                    together.begin()));
    }
}

}  // namespace vfplan::test
