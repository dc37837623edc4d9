// What certainly does not fit into memory is refused before work begins.
#include "engine/job/needs.h"

#include <gtest/gtest.h>

#include "kernels/error.h"
#include "tests/words.h"

namespace vfplan {
namespace {

using test::expect_words;

Layout layout(std::int32_t nx, std::int32_t ny, double cell_m, double range_m,
              std::int64_t tile_cells = 1024) {
    return make_layout({{0, 0}, cell_m, nx, ny}, range_m, tile_cells);
}

std::string refusal(const GroundOptions& o, const Layout& l, std::int64_t pieces, double bytes,
                    bool plan = true) {
    try {
        check_memory(o, l, pieces, plan, {bytes, "this machine has"});
    } catch (const UsageError& e) {
        return e.what();
    }
    return "";
}

TEST(Needs, WhatFitsIsNotRefused) {
    GroundOptions o;
    o.cell_m = 2;
    o.range_max_m = 75;
    EXPECT_EQ(refusal(o, layout(30000, 16000, 2, 75), 20'000'000, 1e9), "");
}

TEST(Needs, CellsRangeTilesAndPiecesSayWhatToChange) {
    GroundOptions o;
    o.cell_m = 0.25;
    o.range_max_m = 10;
    expect_words(refusal(o, layout(300000, 300000, 0.25, 10), 1000, 4e9),
                 {"field.cell_m = 0.25", "9e+10 cells", "this machine has 4 GB", "0.42 or more"});
    o.range_max_m = 5000;
    expect_words(refusal(o, layout(20000, 20000, 0.25, 5000), 1000, 1.5e9),
                 {"scanner.range_max_m = 5000", "shorter range"});
    o.range_max_m = 100;
    o.tile_cells = 16384;
    expect_words(refusal(o, layout(60000, 60000, 0.25, 100, 16384), 1000, 4e9),
                 {"field.tile_cells = 16384", "smaller tiles"});
    o.tile_cells = 1024;
    o.partition_m = 0.001;
    const Layout small = layout(500, 500, 0.25, 100);
    expect_words(refusal(o, small, 1'000'000'000, 4e9),
                 {"coverage.partition_m = 0.001", "0.0023 or more"});
    EXPECT_EQ(refusal(o, small, 1'000'000'000, 4e9, false), "") << "tables alone hold less";
}

TEST(Needs, TheLimitIsThereAndHasAName) {
    const MemoryLimit limit = memory_limit();
    EXPECT_GT(limit.bytes, 1e8);
    EXPECT_LT(limit.bytes, 1e17);
    EXPECT_FALSE(limit.whose.empty());
}

}  // namespace
}  // namespace vfplan
