// Ridge splitting: middles until neighbours overlap enough (docs/method.md 3).
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/engine/tables/ground.h"

namespace vfplan {
namespace {

using test::box_ring;
using test::CandidateOptions;
using test::CandidateResult;
using test::cells_of;
using test::hall;
using test::Lines;
using test::overlap_of;
using test::World;
using enum CandidateKind;

// What splitting a straight path must insert: middles until neighbours overlap enough.
void insert_middles(const World& w, const CandidateOptions& o,
                    const std::vector<std::int64_t>& path, std::size_t from, std::size_t to,
                    std::set<std::int64_t>& out) {
    const auto row = [&](std::size_t i) { return OverlapRow(w.row(path[i]), w.pieces); };
    if (overlap(o.ratio, row(from), row(to)) >= o.threshold || to < from + 2) return;
    const std::size_t half = (from + to) / 2;
    out.insert(path[half]);
    insert_middles(w, o, path, from, half, out);
    insert_middles(w, o, path, half, to, out);
}

TEST(Splitting, MiddlesUntilNeighboursOverlapEnough) {
    World::Setting s;
    s.scanner.range_max_m = 9;
    const World w = hall(90, 6, s);
    const Lines g = w.drawn({{{5, 3}, {85, 3}}});
    ASSERT_EQ(g.ridges.size(), 1U);
    const std::vector<std::int64_t>& cells = g.ridges[0].cells;
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
            EXPECT_EQ(r.arcs_short_of_overlap, 0);
            last = std::max(last, want.size());
        }
    }
    EXPECT_GT(last, 20U);
}

// A line along y between two joints: arms of a few cells across it at its ends.
Lines between_joints(const World& w, double x0, double x1, double y) {
    return w.drawn({{{x0, y}, {x1, y}}, {{x0, y - 2}, {x0, y + 2}}, {{x1, y - 2}, {x1, y + 2}}});
}

// The overlap of the two joints of such a line.
double overlap_at_joints(const World& w, const Lines& lines, OverlapRatio ratio) {
    EXPECT_EQ(lines.joints.size(), 2U);
    return overlap(ratio, {w.row(lines.joints[0]), w.pieces}, {w.row(lines.joints[1]), w.pieces});
}

TEST(Splitting, NoSplitWhereOverlapIsEnough) {
    const World w = hall();
    const CandidateResult whole = w.candidates(between_joints(w, 4, 16, 5), overlap_of(0.9));
    EXPECT_EQ(whole.candidates.size(), 2U);  // both see all of the hall
    EXPECT_EQ(whole.arcs_short_of_overlap, 0);
    // The threshold itself is enough.
    World::Setting s;
    s.scanner.range_max_m = 9;
    const World long_hall = hall(90, 6, s);
    const Lines twelve = between_joints(long_hall, 20.5, 32.5, 3);
    const double o = overlap_at_joints(long_hall, twelve, OverlapRatio::mean_len);
    ASSERT_GT(o, 0.05);
    const auto on_the_line = [&](double threshold) {
        const CandidateResult r = long_hall.candidates(twelve, overlap_of(threshold));
        std::int64_t count = 0;
        for (const std::int64_t c : cells_of(r.candidates, split)) {
            const Vec2d p = long_hall.grid.centre(c);
            count += p.x() > 21 && p.x() < 32 && std::abs(p.y() - 3) < 1 ? 1 : 0;
        }
        return count;
    };
    EXPECT_EQ(on_the_line(o), 0);
    EXPECT_GT(on_the_line(o + 1e-9), 0);
}

TEST(Splitting, TheMiddleIsThatOfTheArc) {
    World::Setting s;
    s.scanner.range_max_m = 12;
    const World w = hall(40, 30, s);
    // Two joints; between them a straight part and a diagonal one.
    const Lines lines =
        w.drawn({{{5, 5}, {15, 5}, {29, 19}}, {{5, 2}, {5, 8}}, {{27, 21}, {31, 17}}});
    ASSERT_EQ(lines.joints.size(), 2U);
    std::vector<std::int64_t> path;
    for (const Ridge& ridge : lines.ridges) {
        if (ridge.joint[0] < 0 || ridge.joint[1] < 0) continue;
        path = ridge.cells;
        path.insert(path.begin(), lines.joints[static_cast<std::size_t>(ridge.joint[0])]);
        path.push_back(lines.joints[static_cast<std::size_t>(ridge.joint[1])]);
    }
    ASSERT_GT(path.size(), 20U);
    const std::size_t by_arc = arc_middle(w.grid, path, 0, path.size() - 1);
    const std::size_t by_count = (path.size() - 1) / 2;
    ASSERT_NE(by_arc, by_count);
    const double o = overlap_at_joints(w, lines, OverlapRatio::mean_len);
    // A threshold so small that one middle is enough, if any is.
    const CandidateResult r = w.candidates(lines, overlap_of(std::max(o * 1.0001, 1e-9)));
    const auto inserted = cells_of(r.candidates, split);
    const auto has = [&](std::size_t i) {
        return std::binary_search(inserted.begin(), inserted.end(), path[i]);
    };
    EXPECT_TRUE(has(by_arc));
    EXPECT_FALSE(has(by_count));
}

TEST(Splitting, RingsAreSplitAllTheWayRound) {
    World::Setting s;
    s.scanner.range_max_m = 12;
    const World w(s, {box_ring(0, 0, 40, 40), box_ring(12, 12, 28, 28)});
    const Lines g = w.drawn(
        {{{10, 6}, {30, 6}, {34, 10}, {34, 30}, {30, 34}, {10, 34}, {6, 30}, {6, 10}, {10, 6}}});
    ASSERT_TRUE(g.ridges[0].ring);
    const CandidateResult r = w.candidates(g, overlap_of(0.5));
    EXPECT_EQ(r.arcs_short_of_overlap, 0);
    std::set<std::int64_t> chosen;
    for (const Candidate& c : r.candidates) chosen.insert(c.cell);
    std::vector<OverlapRow> rows;
    for (const std::int64_t c : g.ridges[0].cells) {
        if (chosen.contains(c)) rows.emplace_back(w.row(c), w.pieces);
    }
    ASSERT_GT(rows.size(), 8U);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_GE(overlap(OverlapRatio::mean_len, rows[i], rows[(i + 1) % rows.size()]), 0.5);
    }
}

// What splitting a path of `cells`, joints included (one more on either side belongs to the joint's
// cluster), does when nothing ever overlaps: nothing in
// this lane has to be scanned. Returns ridges that fall short, and points on the path.
std::pair<std::int64_t, std::size_t> split_blindly(std::int32_t cells) {
    World::Setting s;
    s.scanned = false;
    s.scanner.range_max_m = 20;
    s.tile_cells = 1024;
    const World w = hall(cells + 10, 5, s);
    const Lines lines = between_joints(w, 4.5, 4.5 + cells + 1, 2.5);
    EXPECT_EQ(lines.joints.size(), 2U);
    const CandidateResult r = w.candidates(lines, overlap_of(0.3));
    std::set<std::int64_t> on_path;
    for (const Candidate& c : r.candidates) {
        if (w.grid.iy(c.cell) == w.grid.iy(lines.joints[0])) on_path.insert(c.cell);
    }
    return {r.arcs_short_of_overlap, on_path.size()};
}

TEST(Splitting, StopsAtTwoCellsOrDepthSixteenAndIsFlagged) {
    EXPECT_EQ(split_blindly(3), (std::pair<std::int64_t, std::size_t>(1, 3)));
    EXPECT_EQ(split_blindly(100), (std::pair<std::int64_t, std::size_t>(1, 100)));
    // Sixteen halvings make 65536 parts.
    EXPECT_EQ(split_blindly(150000), (std::pair<std::int64_t, std::size_t>(1, 65537)));
}

TEST(Splitting, OnlyTheRidgeThatFallsShortIsFlagged) {
    // A wall without a door crosses the first ridge.
    const World w{{}, {box_ring(0, 0, 10, 10), box_ring(10.5, 0, 20, 10)}};
    const CandidateResult r =
        w.candidates(w.drawn({{{5, 5}, {15, 5}}, {{3, 8}, {8, 8}}}), overlap_of(0.3));
    EXPECT_EQ(r.arcs_short_of_overlap, 1);
    EXPECT_EQ(r.ridges, 2);
}

}  // namespace
}  // namespace vfplan
