// Random numbers that are the same everywhere.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "kernels/index.h"

namespace vfplan {

// SplitMix64: the n-th number follows from the seed and n alone.
class Dice {
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}

    std::uint64_t next() {
        std::uint64_t z = (state_ += 0x9e3779b97f4a7c15U);
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }
    // One of 0 .. n - 1. REQUIRES: 0 < n < 2^31.
    std::int32_t below(std::int64_t n) {
        return static_cast<std::int32_t>(((next() >> 33U) * static_cast<std::uint64_t>(n)) >> 31U);
    }
    // In [0, 1).
    double unit() { return static_cast<double>(next() >> 11U) * 0x1p-53; }
    template <class T>
    void shuffle(std::vector<T>& list) {
        for (std::size_t i = list.size(); i > 1; --i) {
            std::swap(list[i - 1], list[idx(below(static_cast<std::int64_t>(i)))]);
        }
    }

private:
    std::uint64_t state_;
};

// e^-x, by means that give the same bits everywhere; 0 <= x.
inline double fading(double x) {
    if (x >= 64) return 0;
    double y = 1 - x / 1024;
    for (int i = 0; i < 10; ++i) y *= y;
    return y;
}

}  // namespace vfplan
