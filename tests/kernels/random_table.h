// Coverage tables without geometry, and their rows.
#pragma once

#include <cstdint>
#include <random>

#include "kernels/coverage.h"
#include "kernels/index.h"

namespace vfplan::test {

inline CoverageRow row_of(const CoverageTable& table, std::int64_t row) {
    const auto from = table.seen.begin();
    return {from + table.begin[idx(row)], from + table.begin[idx(row) + 1]};
}

// Each row covers each piece with a probability of a quarter.
inline CoverageTable random_table(std::uint64_t seed, int rows, std::int32_t pieces) {
    std::mt19937_64 random(seed);
    CoverageTable table;
    for (int r = 0; r < rows; ++r) {
        CoverageRow row;
        for (std::int32_t p = 0; p < pieces; ++p) {
            if (random() % 4 == 0) {
                row.push_back({p, 1, 0.001F * static_cast<float>(random() % 1000)});
            }
        }
        table.add(row);
    }
    return table;
}

}  // namespace vfplan::test
