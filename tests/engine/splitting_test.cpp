// Ridge splitting: middles until neighbours overlap enough (SPEC section 3).
#include <gtest/gtest.h>

#include <set>

#include "tests/engine/ground.h"

namespace vfplan {
namespace {

using test::box_ring;
using test::cells_of;
using test::hall;
using test::overlap_of;
using test::World;
using enum CandidateKind;

// What splitting a straight path must insert: middles until neighbours overlap enough.
void insert_middles(const World& w, const CandidateOptions& o, const CellPath& path,
                    std::size_t from, std::size_t to, std::set<std::int64_t>& out) {
    const auto row = [&](std::size_t i) { return w.viewer->row(w.grid.centre(path[i])); };
    if (overlap(o.ratio, w.pieces, row(from), row(to)) >= o.threshold || to < from + 2) return;
    const std::size_t half = (from + to) / 2;
    out.insert(path[half]);
    insert_middles(w, o, path, from, half, out);
    insert_middles(w, o, path, half, to, out);
}

TEST(Splitting, MiddlesUntilNeighboursOverlapEnough) {
    World::Setting s;
    s.scanner.range_max_m = 9;
    const World w = hall(90, 6, s);
    const RidgeGraph g = w.drawn({{{5, 3}, {85, 3}}});
    ASSERT_EQ(g.ridges.size(), 1U);
    const CellPath& cells = g.ridges[0].cells;
    std::size_t last = 0;
    for (const OverlapRatio ratio : {OverlapRatio::mean_len, OverlapRatio::union_ang}) {
        for (const double tau : {0.1, 0.3, 0.6, 0.8}) {
            const CandidateOptions o = overlap_of(tau, ratio);
            const CandidateResult r = w.candidates(g, o);
            std::set<std::int64_t> want;
            const std::size_t half = (cells.size() - 1) / 2;
            insert_middles(w, o, cells, 0, half, want);
            insert_middles(w, o, cells, half, cells.size() - 1, want);
            EXPECT_EQ(cells_of(r.candidates, split), std::vector(want.begin(), want.end()));
            EXPECT_EQ(r.report.ridges_short_of_overlap, 0);
            last = std::max(last, want.size());
        }
    }
    EXPECT_GT(last, 20U);
}

TEST(Splitting, NoSplitWhereOverlapIsEnough) {
    const World w = hall();
    const Threads threads(1);
    CandidatePool pool(*w.viewer, threads, w.ground());
    const RidgeGraph g = w.drawn({{{2, 5}, {18, 5}}});
    const CellPath& path = g.ridges[0].cells;
    pool.add({path.front(), path.back()}, joint);
    EXPECT_EQ(split_paths(pool, {path}, overlap_of(0.9)), 0);  // both see all of the hall
    EXPECT_EQ(pool.candidates().size(), 2U);
    // The threshold itself is enough.
    World::Setting s;
    s.scanner.range_max_m = 9;
    const World long_hall = hall(90, 6, s);
    const CellPath twelve = long_hall.drawn({{{20, 3}, {32, 3}}}).ridges[0].cells;
    const double o = overlap(OverlapRatio::mean_len, long_hall.pieces,
                             long_hall.viewer->row(long_hall.grid.centre(twelve.front())),
                             long_hall.viewer->row(long_hall.grid.centre(twelve.back())));
    ASSERT_GT(o, 0);
    for (const bool above : {false, true}) {
        CandidatePool two(*long_hall.viewer, threads, long_hall.ground());
        two.add({twelve.front(), twelve.back()}, joint);
        split_paths(two, {twelve}, overlap_of(above ? std::nextafter(o, 1) : o));
        EXPECT_EQ(two.candidates().size() > 2, above);
    }
}

TEST(Splitting, TheMiddleIsThatOfTheArc) {
    World::Setting s;
    s.scanner.range_max_m = 12;
    const World w = hall(40, 30, s);
    const CellPath path = w.drawn({{{5, 5}, {15, 5}, {29, 19}}}).ridges[0].cells;
    ASSERT_EQ(path.size(), 25U);
    const Threads threads(1);
    CandidatePool pool(*w.viewer, threads, w.ground());
    pool.add({path.front(), path.back()}, joint);
    split_paths(pool, {path}, overlap_of(0.3));
    // 10 + 14 sqrt(2) = 29.8; half lies 3.46 diagonal steps behind the bend.
    ASSERT_GT(pool.candidates().size(), 2U);
    EXPECT_EQ(pool.candidates()[2].cell, path[13]);
    EXPECT_EQ(pool.candidates()[2].kind, split);
}

TEST(Splitting, RingsAreSplitAllTheWayRound) {
    World::Setting s;
    s.scanner.range_max_m = 12;
    const World w(s, {box_ring(0, 0, 40, 40), box_ring(12, 12, 28, 28)});
    const RidgeGraph g = w.drawn(
        {{{10, 6}, {30, 6}, {34, 10}, {34, 30}, {30, 34}, {10, 34}, {6, 30}, {6, 10}, {10, 6}}});
    ASSERT_TRUE(g.ridges[0].ring);
    const CandidateResult r = w.candidates(g, overlap_of(0.5));
    EXPECT_EQ(r.report.ridges_short_of_overlap, 0);
    std::set<std::int64_t> chosen;
    for (const Candidate& c : r.candidates) chosen.insert(c.cell);
    std::vector<CoverageRow> rows;
    for (const std::int64_t c : g.ridges[0].cells) {
        if (chosen.contains(c)) rows.push_back(w.viewer->row(w.grid.centre(c)));
    }
    ASSERT_GT(rows.size(), 8U);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_GE(overlap(OverlapRatio::mean_len, w.pieces, rows[i], rows[(i + 1) % rows.size()]),
                  0.5);
    }
}

// Sees no wall at all.
class Blind final : public ViewKernel {
public:
    void first_hits(const Vec2d&, View& out) const override { out.clear(); }
    FieldCounts field(const Scanner&, const Grid&, const Window&, const Raster<std::uint8_t>&,
                      Raster<float>&) const override {
        return {};
    }
};

// What splitting a row of `cells` does when nothing ever overlaps.
std::pair<std::int64_t, std::size_t> split_blindly(std::int32_t cells) {
    const std::vector<Wall> walls = {test::wall({0, 5}, {1, 5})};
    const Pieces pieces = cut_into_pieces(walls, 1);
    const Blind blind;
    const Viewer viewer(blind, walls, pieces, {}, 0.5);
    const Grid grid{{0, 0}, 1, cells, 1};
    const auto n = static_cast<std::size_t>(cells);
    const Raster<float> field(n, 1);
    const Raster<std::uint8_t> ones(n, 1);
    const Raster<std::uint8_t> zeros(n, 0);
    const Threads threads(1);
    const Ground ground{grid, field, ones, zeros, ones};
    CandidatePool pool(viewer, threads, ground);
    CellPath path(n);
    for (std::size_t i = 0; i < n; ++i) path[i] = static_cast<std::int64_t>(i);
    pool.add({path.front(), path.back()}, joint);
    const std::int64_t flagged = split_paths(pool, {path, {path.front()}}, overlap_of(0.3));
    return {flagged, pool.candidates().size()};
}

TEST(Splitting, StopsAtTwoCellsOrDepthSixteenAndIsFlagged) {
    EXPECT_EQ(split_blindly(2), (std::pair<std::int64_t, std::size_t>(1, 2)));
    EXPECT_EQ(split_blindly(3), (std::pair<std::int64_t, std::size_t>(1, 3)));
    EXPECT_EQ(split_blindly(100), (std::pair<std::int64_t, std::size_t>(1, 100)));
    // Sixteen halvings make 65536 parts.
    EXPECT_EQ(split_blindly(400000), (std::pair<std::int64_t, std::size_t>(1, 65537)));
}

TEST(Splitting, OnlyTheRidgeThatFallsShortIsFlagged) {
    // A wall without a door crosses the first ridge.
    const World w{{}, {box_ring(0, 0, 10, 10), box_ring(10.5, 0, 20, 10)}};
    const CandidateResult r =
        w.candidates(w.drawn({{{5, 5}, {15, 5}}, {{3, 8}, {8, 8}}}), overlap_of(0.3));
    EXPECT_EQ(r.report.ridges_short_of_overlap, 1);
    EXPECT_EQ(r.report.ridges, 2);
}

}  // namespace
}  // namespace vfplan
