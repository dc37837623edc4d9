// What planning reads of the coverage table.
#include "engine/plan/planning.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/io/site/features.h"
#include "tests/kernels/random_table.h"

namespace vfplan {
namespace {

TEST(PlanTables, HoldTheRowsThatTheFileHas) {
    // In two blocks: rows 0 to 29 and the rest.
    const CoverageTable table = test::random_table(2, 50, 20);
    std::vector<Wall> walls(20, {Vec2d(0, 0), Vec2d(1, 0)});
    const test::TemporaryFolder folder("rows");
    std::filesystem::create_directories(folder.path() / "shards");
    std::vector<std::filesystem::path> blocks;
    for (const auto& [from, to] : {std::pair(0, 30), std::pair(30, 50)}) {
        CoverageBlock block;
        block.candidates.resize(idx(to - from));
        for (std::int64_t r = from; r < to; ++r) {
            block.table.add(test::row_of(table, r));
        }
        blocks.push_back(folder.path() / "shards" /
                         fmt::format("coverage-{:05}.h5", blocks.size()));
        write_coverage_block(blocks.back(), "key", block);
    }
    const std::filesystem::path path = folder.path() / "coverage.h5";
    write_coverage_index(path, walls, cut_into_pieces(walls, 2), blocks, {});
    const CoverageTables tables = read_coverage(path);
    const CoverageEntries entries(path);
    const OverlapRows want = overlap_rows(table, true);
    const PlanTables by_angle = plan_tables_of(tables, entries, OverlapRatio::mean_ang);
    EXPECT_EQ(by_angle.rows.begin, want.begin);
    EXPECT_EQ(by_angle.rows.piece, want.piece);
    EXPECT_EQ(by_angle.rows.angle_rad, want.angle_rad);
    EXPECT_EQ(by_angle.piece_length_m, std::vector<double>(40, 1.0));
    const PlanTables by_length = plan_tables_of(tables, entries, OverlapRatio::mean_len);
    EXPECT_EQ(by_length.rows.piece, want.piece);
    EXPECT_TRUE(by_length.rows.angle_rad.empty());
    EXPECT_EQ(by_length.angles(7, 30),
              std::vector<float>(want.angle_rad.begin() + 7, want.angle_rad.begin() + 37));
}

}  // namespace
}  // namespace vfplan
