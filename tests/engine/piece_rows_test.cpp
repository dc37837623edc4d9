// The planner's compact tables hold what the coverage tables hold.
#include "engine/piece_rows.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <random>

#include "engine/piece_places.h"
#include "engine/plan_stage.h"
#include "tests/io/features.h"

namespace vfplan {
namespace {

CoverageTable random_table(std::uint64_t seed, int rows, std::int32_t pieces) {
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

TEST(PieceRows, HoldTheTable) {
    const CoverageTable table = random_table(1, 40, 30);
    const PieceRows rows = piece_rows(table, true);
    ASSERT_EQ(rows.size(), 40);
    const std::vector<float> angles = angles_of(table)(0, rows.entries());
    EXPECT_EQ(rows.angle_rad, angles);
    for (std::int32_t r = 0; r < rows.size(); ++r) {
        const Seen* s = table.row_begin(r);
        for (const std::int32_t p : rows.row(r)) EXPECT_EQ((s++)->piece, p);
        EXPECT_EQ(s, table.row_end(r));
    }
    EXPECT_TRUE(piece_rows(table, false).angle_rad.empty());
}

TEST(PieceRows, AreReadFromTheFileAsTheyWere) {
    // In two blocks: rows 0 to 29 and the rest.
    const CoverageTable table = random_table(2, 50, 20);
    std::vector<Wall> walls(20, {Vec2d(0, 0), Vec2d(1, 0)});
    const test::TemporaryFolder folder("rows");
    std::filesystem::create_directories(folder.path() / "shards");
    std::vector<std::filesystem::path> blocks;
    for (const auto& [from, to] : {std::pair(0, 30), std::pair(30, 50)}) {
        CoverageBlock block;
        block.candidates.resize(at(to - from));
        for (std::int64_t r = from; r < to; ++r) {
            block.table.add({table.row_begin(r), table.row_end(r)});
        }
        blocks.push_back(folder.path() / "shards" / fmt::format("block-{:05}.h5", blocks.size()));
        h5::Writer file(blocks.back());
        write_block(file, block);
        file.close();
    }
    const std::filesystem::path path = folder.path() / "coverage.h5";
    write_coverage_index(path, walls, cut_into_pieces(walls, 2), blocks, {});
    const CoverageTables tables = read_coverage(path);
    const CoverageEntries entries(path);
    const PieceRows want = piece_rows(table, true);
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

TEST(PieceRows, IndexListsTheRowsOfEachPiece) {
    const PieceRows rows = piece_rows(random_table(3, 40, 30), false);
    const PieceIndex index = index_of(rows, 33);
    ASSERT_EQ(index.pieces(), 33);
    for (std::int32_t p = 0; p < 33; ++p) {
        std::vector<std::int32_t> want;
        for (std::int32_t r = 0; r < rows.size(); ++r) {
            const auto row = rows.row(r);
            if (std::find(row.begin(), row.end(), p) != row.end()) want.push_back(r);
        }
        const auto got = index.rows_of(p);
        EXPECT_EQ(std::vector<std::int32_t>(got.begin(), got.end()), want);
    }
    EXPECT_EQ(index_of(PieceRows(), 0).pieces(), 0);
}

TEST(SharedLengths, AddUpByRowHoweverMany) {
    std::mt19937_64 random(4);
    SharedLengths shared;
    for (const std::uint64_t rows : {3U, 5000U, 40U}) {  // grows, and forgets
        std::map<std::int32_t, double> want;
        for (int i = 0; i < 20000; ++i) {
            const auto row = static_cast<std::int32_t>(random() % rows * 1048576 % 2000000011);
            const double length = 0.1 * static_cast<double>(random() % 50);
            want[row] += length;
            shared.add(row, length);
        }
        std::map<std::int32_t, double> got;
        shared.take(
            [&](std::int32_t row, double length) { EXPECT_TRUE(got.emplace(row, length).second); });
        EXPECT_EQ(got, want);
    }
}

TEST(PiecePlaces, LieWherePiecesWereCut) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> number(-20, 20);
    std::vector<Wall> walls(60);
    for (std::size_t w = 0; w < walls.size(); ++w) {
        walls[w].a = {number(random), number(random)};
        walls[w].b = {number(random), number(random)};
        walls[w].scanned = w % 7 != 3;
        walls[w].free_side[left] = w % 3 != 0;
        walls[w].free_side[right] = w % 5 != 0;
    }
    const Pieces pieces = cut_into_pieces(walls, 1);
    const PiecePlaces places(walls, pieces);
    std::vector<std::int32_t> some;
    for (std::int32_t p = 0; p < pieces.size(); ++p) {
        if (p < 50 || random() % 3 == 0) some.push_back(p);
    }
    std::size_t called = 0;
    places.each(some, [&](std::int32_t p, const PiecePlaces::Place& place) {
        EXPECT_EQ(p, some[called++]);
        const Pieces::Place piece = pieces.place(p);
        const Wall& wall = walls[at(piece.wall)];
        EXPECT_EQ(place.middle, wall.at((piece.s0_m + piece.s1_m) / 2));
        EXPECT_EQ(place.along, (wall.b - wall.a).normalized());
    });
    EXPECT_EQ(called, some.size());
}

}  // namespace
}  // namespace vfplan
