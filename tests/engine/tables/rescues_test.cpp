// Pieces that no joint or ridge sees: rescued, or without viewpoint (docs/method.md 4).
#include <gtest/gtest.h>

#include "kernels/index.h"
#include "kernels/overlap_rows.h"
#include "tests/engine/tables/ground.h"

namespace vfplan {
namespace {

using test::box_ring;
using test::CandidateOptions;
using test::CandidateResult;
using test::cells_of;
using test::Lines;
using test::ring_of;
using test::World;
using enum CandidateKind;

// Says of each piece whether some free cell covers it, by looking from all.
std::vector<std::uint8_t> coverable(const World& w) {
    std::vector<std::uint8_t> out(idx(w.pieces.size()), 0);
    for (std::int64_t c = 0; c < w.grid.size(); ++c) {
        if (w.standable[idx(c)] == 0) continue;
        for (const Seen& s : w.row(c)) out[idx(s.piece)] = 1;
    }
    return out;
}

// Status must be covered where some free cell covers, else no_viewpoint; every rescue must be a
// free cell that covers something that no other candidate of another kind does.
void expect_right(const World& w, const CandidateResult& r) {
    const std::vector<std::uint8_t> want = coverable(w);
    const PieceIndex index = index_of(overlap_rows(r.table, false), w.pieces.size());
    for (std::size_t p = 0; p < want.size(); ++p) {
        EXPECT_EQ(r.status[p] == PieceStatus::covered, index.begin[p + 1] > index.begin[p]);
        EXPECT_EQ(r.status[p], want[p] != 0 ? PieceStatus::covered : PieceStatus::no_viewpoint)
            << "piece " << p << " of wall " << w.pieces.place(static_cast<std::int64_t>(p)).wall;
    }
    for (std::size_t i = 0; i < r.candidates.size(); ++i) {
        if (r.candidates[i].kind != rescue) continue;
        EXPECT_NE(w.standable[idx(r.candidates[i].cell)], 0);
        bool alone = false;
        for (std::int64_t k = r.table.begin[i]; k < r.table.begin[i + 1]; ++k) {
            bool other = false;
            const auto p = idx(r.table.seen[idx(k)].piece);
            for (std::int64_t j = index.begin[p]; j < index.begin[p + 1]; ++j) {
                const CandidateKind kind = r.candidates[idx(index.row[idx(j)])].kind;
                other = other || (kind != rescue && kind != connector);
            }
            alone = alone || !other;
        }
        EXPECT_TRUE(alone);
    }
}

// Two rooms without a door; the ridge lies in the left one.
struct TwoRooms : World {
    explicit TwoRooms(const Setting& s)
        : World(s, {box_ring(0, 0, 10, 10), box_ring(12, 0, 22, 10)}) {}
    CandidateResult found(const CandidateOptions& o = {}) const {
        return candidates(drawn({{{3, 5}, {7, 5}}}), o);
    }
};

TEST(Rescue, WhatNoRidgeSeesIsSeenFromAFreeCell) {
    const TwoRooms w({});
    const CandidateResult r = w.found();
    expect_right(w, r);
    EXPECT_EQ(cells_of(r.candidates, rescue).size(), 1U);  // one sees the whole room
    EXPECT_EQ(r.rescued_pieces, 40);
    for (const Candidate& c : r.candidates) {
        if (c.kind == rescue) {
            EXPECT_EQ(c.vf_rad, w.field[idx(c.cell)]);
        }
    }
}

TEST(Rescue, NothingToRescue) {
    const World w({}, {box_ring(0, 0, 10, 10)});
    const CandidateResult r = w.candidates(w.drawn({{{3, 5}, {7, 5}}}), {});
    EXPECT_TRUE(cells_of(r.candidates, rescue).empty());
    EXPECT_EQ(r.rescued_pieces, 0);
}

TEST(Rescue, ThePointsOfTheUserCountFirst) {
    const TwoRooms w({});
    CandidateOptions o;
    o.required = {{15.2, 4.1}};
    const CandidateResult r = w.found(o);
    expect_right(w, r);
    EXPECT_TRUE(cells_of(r.candidates, rescue).empty());
}

TEST(Rescue, ASlitThatNoCellSeesHasNoViewpoint) {
    // A lane of 0.2 m between two rows of cells, with a bend.
    const World w({}, {ring_of({{0, 0},
                                {10, 0},
                                {10, 4.9},
                                {15, 4.9},
                                {15, 8},
                                {14.8, 8},
                                {14.8, 5.1},
                                {10, 5.1},
                                {10, 10},
                                {0, 10}})});
    const CandidateResult r = w.candidates(w.drawn({{{3, 5}, {7, 5}}}), {});
    expect_right(w, r);
    const auto lost = std::count(r.status.begin(), r.status.end(), PieceStatus::no_viewpoint);
    EXPECT_GT(lost, w.pieces.size() / 2);  // outer sides, and behind the bend
    for (std::size_t p = 0; p < r.status.size(); ++p) {
        const Wall& wall = w.walls[idx(w.pieces.place(static_cast<std::int64_t>(p)).wall)];
        if (std::min(wall.a.y(), wall.b.y()) > 7.9 && wall.a.x() > 11) {
            EXPECT_EQ(r.status[p], PieceStatus::no_viewpoint);
        }
    }
}

TEST(Rescue, RespectsWhatTheScannerObserves) {
    for (const Scanner& scanner :
         {Scanner{0.1, 3, 90}, Scanner{4, 5.5, 90}, Scanner{2.5, 30, 90}, Scanner{0.1, 30, 25},
          Scanner{1, 6, 40}, Scanner{6.5, 8, 90}, Scanner{9, 11, 20}}) {
        for (const double fraction : {0.3, 0.5, 0.95, 1.0}) {
            World::Setting s;
            s.scanner = scanner;
            s.visible_fraction = fraction;
            const TwoRooms w(s);
            const CandidateResult r = w.found();
            SCOPED_TRACE(testing::Message() << scanner.range_min_m << " " << scanner.range_max_m
                                            << " " << scanner.max_incidence_deg << " " << fraction);
            expect_right(w, r);
        }
    }
}

TEST(Rescue, InNooksAndBehindPillars) {
    for (const auto& [cell, fraction] :
         {std::pair(0.5, 0.5), std::pair(1.0, 0.5), std::pair(1.0, 0.9), std::pair(2.0, 1.0)}) {
        World::Setting s;
        s.cell_m = cell;
        s.visible_fraction = fraction;
        s.partition_m = 0.7;
        s.scanner.range_max_m = 15;
        const World w(s, {ring_of({{0, 0},
                                   {30, 0},
                                   {30, 6},
                                   {27, 6},
                                   {27, 9},
                                   {30, 9},
                                   {30, 20},
                                   {16, 20},
                                   {16, 15},
                                   {13, 15},
                                   {13, 20},
                                   {0, 20}}),
                          box_ring(4, 4, 6, 9), box_ring(11, 3, 15, 5), box_ring(20, 8, 21, 17)});
        const CandidateResult r = w.candidates(w.drawn({{{9, 8}, {9, 14}}}), {});
        expect_right(w, r);
        EXPECT_FALSE(cells_of(r.candidates, rescue).empty());
    }
}

TEST(Rescue, CellsInsideTheDomainComeFirst) {
    // The domain: one corner of the right room, though more is seen from elsewhere.
    World::Setting s;
    s.scanner.range_max_m = 14;
    TwoRooms w(s);
    std::fill(w.closed.begin(), w.closed.end(), 0xff);  // what no domain reaches
    for (const auto& [x, y] : {std::pair(13.5, 8.5), std::pair(14.5, 8.5)}) {
        w.closed[idx(w.cell(x, y))] = 0;
        w.field[idx(w.cell(x, y))] = 0.5F + static_cast<float>(x) / 100;
    }
    const CandidateResult r = w.found();
    EXPECT_EQ(cells_of(r.candidates, rescue), std::vector{w.cell(14.5, 8.5)});  // greater VF
    // Without any, the cell with the greatest VF.
    std::fill(w.closed.begin(), w.closed.end(), 0xff);
    w.field[idx(w.cell(19.5, 2.5))] = 6.5;
    EXPECT_EQ(cells_of(w.found().candidates, rescue), std::vector{w.cell(19.5, 2.5)});
}

TEST(Rescue, APieceThatARescueSeesNeedsNoOther) {
    // Two cells: all that the second sees the first sees too, and only that the first piece.
    World::Setting s;
    s.scanner.range_max_m = 6;
    TwoRooms w(s);
    const std::int64_t wide = w.cell(19.5, 2.5);
    const std::int64_t narrow = w.cell(20.5, 1.5);
    for (std::int64_t c = 0; c < w.grid.size(); ++c) {
        if (w.grid.centre(c).x() < 11 || c == wide || c == narrow) continue;
        w.field[idx(c)] = std::nanf("");
        w.standable[idx(c)] = 0;
    }
    w.field[idx(wide)] = 6.0F;
    w.field[idx(narrow)] = 6.2F;  // preferred where both see
    const CandidateResult r = w.found();
    expect_right(w, r);
    for (const Candidate& c : r.candidates) {
        if (c.at.x() > 11) {
            EXPECT_EQ(c.cell, wide);
        }
    }
}

TEST(Rescue, NoStationStandsWhereTheFieldIsNaN) {
    TwoRooms w({});
    for (std::int64_t c = 0; c < w.grid.size(); ++c) {
        if (w.grid.centre(c).x() < 11 || c == w.cell(20.5, 1.5)) continue;
        w.field[idx(c)] = std::nanf("");
        w.standable[idx(c)] = 0;
    }
    const CandidateResult r = w.found();
    expect_right(w, r);
    EXPECT_EQ(cells_of(r.candidates, rescue), std::vector{w.cell(20.5, 1.5)});
}

TEST(Rescue, SmallPartsOfAPieceCount) {
    // A piece of 10 m, seen through a window: a few decimetres of it, from each cell others.
    World::Setting s;
    s.partition_m = 10;
    s.visible_fraction = 0.02;
    for (const double y : {3.0, 3.3, 3.6, 3.9, 4.2}) {
        const World w(s, {ring_of({{0, 0},
                                   {10, 0},
                                   {10, y},
                                   {18, y},
                                   {18, 0},
                                   {19, 0},
                                   {19, 10},
                                   {18, 10},
                                   {18, y + 0.25},
                                   {10, y + 0.25},
                                   {10, 10},
                                   {0, 10}})});
        expect_right(w, w.candidates(w.drawn({{{3, 8}, {7, 8}}}), {}));
    }
}

TEST(Rescue, SameForAnyNumberOfThreads) {
    World::Setting s;
    s.scanner.range_max_m = 6;
    const TwoRooms w(s);
    const Lines g = w.drawn({{{3, 5}, {7, 5}}});
    const CandidateResult one = w.candidates(g, {}, 1);
    const CandidateResult two = w.candidates(g, {}, 2);
    EXPECT_GT(cells_of(one.candidates, rescue).size(), 1U);
    EXPECT_EQ(cells_of(one.candidates, rescue), cells_of(two.candidates, rescue));
    EXPECT_EQ(one.status, two.status);
    EXPECT_EQ(one.rescued_pieces, two.rescued_pieces);
}

}  // namespace
}  // namespace vfplan
