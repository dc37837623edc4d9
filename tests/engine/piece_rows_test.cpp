// The planner's compact tables hold what the coverage tables hold.
#include "engine/piece_rows.h"

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
    CoverageTables tables;
    tables.table = random_table(2, 50, 20);
    tables.candidates.resize(50);
    tables.walls.assign(20, {Vec2d(0, 0), Vec2d(1, 0)});
    tables.pieces = cut_into_pieces(tables.walls, 2);
    tables.reach.assign(static_cast<std::size_t>(tables.pieces.size()), PieceStatus::covered);
    const test::TemporaryFile file("coverage.h5");
    write_coverage(file.path(), tables);
    const PieceRows want = piece_rows(tables.table, true);
    const PieceRows got = read_piece_rows(file.path(), true);
    EXPECT_EQ(got.begin, want.begin);
    EXPECT_EQ(got.piece, want.piece);
    EXPECT_EQ(got.angle_rad, want.angle_rad);
    EXPECT_TRUE(read_piece_rows(file.path(), false).angle_rad.empty());
    const AngleSource angles = angles_of(file.path());
    EXPECT_EQ(angles(7, 30),
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
    const PiecePlaces places(walls, pieces.first_of, pieces.size());
    std::vector<std::int32_t> some;
    for (std::int32_t p = 0; p < pieces.size(); ++p) {
        if (p < 50 || random() % 3 == 0) some.push_back(p);
    }
    std::size_t called = 0;
    places.each(some, [&](std::int32_t p, const PiecePlaces::Place& place) {
        EXPECT_EQ(p, some[called++]);
        const Wall& wall = walls[at(pieces.wall[at(p)])];
        EXPECT_EQ(place.middle, wall.at((pieces.s0_m[at(p)] + pieces.s1_m[at(p)]) / 2));
        EXPECT_EQ(place.along, (wall.b - wall.a).normalized());
    });
    EXPECT_EQ(called, some.size());
}

}  // namespace
}  // namespace vfplan
