// Which points of a skeleton become candidates, and in which order (docs/method.md 3).
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "tests/engine/tables/ground.h"
#include "tests/kernels/random_table.h"

namespace vfplan {
namespace {

using test::box_ring;
using test::CandidateOptions;
using test::CandidateResult;
using test::cells_of;
using test::hall;
using test::Lines;
using test::overlap_of;
using test::ring_of;
using test::row_has;
using test::World;
using enum CandidateKind;

const CandidateOptions unsplit = overlap_of(1e-12);

std::vector<std::int64_t> sorted(std::vector<std::int64_t> v) {
    std::sort(v.begin(), v.end());
    return v;
}

TEST(Candidates, JointsBecomeCandidates) {
    const World w = hall();
    const Lines g = w.drawn({{{3, 5}, {17, 5}}, {{6, 2}, {6, 8}}, {{14, 5}, {14, 8}}});
    const CandidateResult r = w.candidates(g, unsplit);
    EXPECT_EQ(cells_of(r.candidates, joint), (std::vector{w.cell(6, 5), w.cell(14, 5)}));
    EXPECT_EQ(r.candidates.size(), 2U);  // from there all is seen: no ends, no middles
    EXPECT_EQ(r.joints, 2);
    EXPECT_EQ(r.ridges, static_cast<std::int64_t>(g.ridges.size()));
    for (std::size_t i = 0; i < r.candidates.size(); ++i) {
        const Candidate& c = r.candidates[i];
        EXPECT_EQ(c.at, w.grid.centre(c.cell));
        EXPECT_EQ(c.vf_rad, w.field[static_cast<std::size_t>(c.cell)]);
        const CoverageRow row = w.row(c.at);
        const CoverageRow got = test::row_of(r.table, static_cast<std::int64_t>(i));
        EXPECT_TRUE(std::equal(row.begin(), row.end(), got.begin(), got.end(),
                               [](const Seen& a, const Seen& b) { return a.piece == b.piece; }));
    }
}

TEST(Candidates, ARidgeWithoutJointGivesItsMiddleByArcLength) {
    const World w = hall();
    EXPECT_EQ(cells_of(w.candidates(w.drawn({{{4, 5}, {14, 5}}}), unsplit).candidates, middle),
              std::vector{w.cell(9, 5)});
    // Ten steps of 1, then six of sqrt(2): half of 18.5 is 9.2 steps on, by count it were 8.
    const CandidateResult bent = w.candidates(w.drawn({{{2, 2}, {12, 2}, {18, 8}}}), unsplit);
    EXPECT_EQ(cells_of(bent.candidates, middle), std::vector{w.cell(11, 2)});
    // One and two cells: the first.
    const CandidateResult small =
        w.candidates(w.drawn({{{4, 3}}, {{10, 5}, {11, 5}}, {{15, 7}, {16, 7}, {17, 7}}}), unsplit);
    EXPECT_EQ(cells_of(small.candidates, middle),
              sorted({w.cell(4, 3), w.cell(10, 5), w.cell(16, 7)}));
    EXPECT_EQ(small.joints, 0);
}

TEST(Candidates, APureRingGivesTwoOppositePoints) {
    const World w{{}, {box_ring(0, 0, 40, 40), box_ring(12, 12, 28, 28)}};
    const Lines g = w.drawn(
        {{{10, 6}, {30, 6}, {34, 10}, {34, 30}, {30, 34}, {10, 34}, {6, 30}, {6, 10}, {10, 6}}});
    ASSERT_EQ(g.ridges.size(), 1U);
    ASSERT_TRUE(g.ridges[0].ring);
    const CandidateResult r = w.candidates(g, unsplit);
    const auto points = cells_of(r.candidates, ring);
    ASSERT_EQ(points.size(), 2U);
    EXPECT_TRUE(cells_of(r.candidates, middle).empty());
    EXPECT_TRUE(cells_of(r.candidates, end).empty());
    EXPECT_NEAR((w.grid.centre(points[0]) + w.grid.centre(points[1]) - Vec2d(41, 41)).norm(), 0,
                1.5);  // symmetric about the ring's centre
    EXPECT_GT((w.grid.centre(points[0]) - w.grid.centre(points[1])).norm(), 28);
}

TEST(Candidates, ARidgeEndIsKeptExactlyWhereItAddsCoverage) {
    // A hall with a lane from its right side that turns up: only the lane's end is news.
    const World w{{},
                  {ring_of({{0, 0},
                            {10, 0},
                            {10, 4},
                            {20, 4},
                            {20, 14},
                            {17, 14},
                            {17, 7},
                            {10, 7},
                            {10, 10},
                            {0, 10}})}};
    const Lines g = w.drawn({{{2, 5}, {15.5, 5}, {18.5, 8}, {18.5, 12}}, {{5, 5}, {5, 8}}});
    const CandidateResult r = w.candidates(g, unsplit);
    EXPECT_EQ(cells_of(r.candidates, joint), std::vector{w.cell(5, 5)});
    EXPECT_EQ(cells_of(r.candidates, end), std::vector{w.cell(18.5, 12)});

    // A short range: all four ends are news, and by brute force elsewhere.
    for (const double range : {5.5, 8.0, 10.0, 12.0, 14.0, 17.0}) {
        World::Setting s;
        s.scanner.range_max_m = range;
        const World h = hall(30, 10, s);
        const Lines plus = h.drawn({{{6, 5}, {28, 5}}, {{12, 5}, {12, 2}}, {{12, 5}, {12, 8}}});
        const CandidateResult found = h.candidates(plus, overlap_of(0.3));
        const CoverageRow from_joint = h.row(h.grid.centre(h.cell(12, 5)));
        std::vector<std::int64_t> want;
        for (const auto& [x, y] :
             {std::pair(6., 5.), std::pair(28., 5.), std::pair(12., 2.), std::pair(12., 8.)}) {
            const CoverageRow row = h.row(h.grid.centre(h.cell(x, y)));
            if (std::any_of(row.begin(), row.end(),
                            [&](const Seen& k) { return !row_has(from_joint, k.piece); })) {
                want.push_back(h.cell(x, y));
            }
        }
        EXPECT_EQ(cells_of(found.candidates, end), sorted(want)) << range;
    }
}

// Sites with their true skeletons.
struct Real {
    std::unique_ptr<World> world;
    CandidateOptions options;
};

std::vector<Real> real_sites() {
    World::Setting near;
    near.scanner.range_max_m = 14;
    World::Setting fine;
    fine.scanner = {0.6, 12, 70};
    fine.cell_m = 0.5;
    const std::vector<Ring> halls = {ring_of({{0, 0},
                                              {50, 0},
                                              {50, 30},
                                              {30, 30},
                                              {30, 8},
                                              {20, 8},
                                              {20, 40},
                                              {12, 40},
                                              {12, 8},
                                              {0, 8}})};
    const std::vector<Ring> pillar = {box_ring(0, 0, 40, 40), box_ring(12, 12, 28, 28)};
    const std::vector<Ring> blocks = {box_ring(0, 0, 50, 30), box_ring(8, 8, 14, 20),
                                      box_ring(22, 6, 30, 14), box_ring(24, 18, 44, 24)};
    std::vector<Real> out;
    out.push_back({std::make_unique<World>(near, halls), overlap_of(0.5)});
    out.push_back({std::make_unique<World>(fine, pillar), overlap_of(0.4)});
    out.push_back({std::make_unique<World>(fine, blocks), overlap_of(0.5, OverlapRatio::min_len)});
    return out;
}

// Neighbours along every ridge, closed rings included.
TEST(Candidates, NeighboursAlongRidgesOverlapEnough) {
    std::size_t pairs = 0;
    for (const Real& site : real_sites()) {
        const World& w = *site.world;
        const Lines g = w.ridges();
        const CandidateResult r = w.candidates(g, site.options);
        EXPECT_EQ(r.arcs_short_of_overlap, 0);
        std::set<std::int64_t> chosen;
        for (const Candidate& c : r.candidates) {
            if (c.kind <= split) chosen.insert(c.cell);
        }
        for (const Ridge& ridge : g.ridges) {
            std::vector<std::int64_t> path = ridge.cells;
            const auto joint_at = [&](int k) {
                return g.joints[static_cast<std::size_t>(ridge.joint[k])];
            };
            if (ridge.joint[0] >= 0) path.insert(path.begin(), joint_at(0));
            if (ridge.joint[1] >= 0) path.push_back(joint_at(1));
            if (ridge.ring) path.insert(path.end(), ridge.cells.begin(), ridge.cells.end());
            std::int64_t last = -1;
            for (const std::int64_t c : path) {
                if (!chosen.contains(c)) continue;
                if (last >= 0) {
                    ++pairs;
                    EXPECT_GE(
                        overlap(site.options.ratio, {w.row(last), w.pieces}, {w.row(c), w.pieces}),
                        site.options.threshold);
                }
                last = c;
            }
        }
    }
    EXPECT_GT(pairs, 40U);
}

TEST(Candidates, SameForAnyNumberOfThreads) {
    for (const Real& site : real_sites()) {
        const Lines g = site.world->ridges();
        const CandidateResult one = site.world->candidates(g, site.options, 1);
        const CandidateResult two = site.world->candidates(g, site.options, 2);
        test::expect_same(one, two);
    }
}

TEST(Candidates, ByPatchThenYThenXAndTheUsersPointsLastAsGiven) {
    std::vector<Real> sites = real_sites();
    Real& site = sites[2];
    site.options.required = {{45.2, 27.1}, {3.3, 3.4}};
    site.options.existing = {{20, 2}, {4, 25}};
    const CandidateResult r = site.world->candidates(site.world->ridges(), site.options);
    ASSERT_GT(r.candidates.size(), 10U);
    const std::size_t own = r.candidates.size() - 4;
    for (std::size_t i = 1; i < own; ++i) {
        const Vec2d& a = r.candidates[i - 1].at;
        const Vec2d& b = r.candidates[i].at;
        const auto patch = [&](const Vec2d& p) {
            const Layout& layout = site.world->layout;
            return layout.patch_of(layout.cell_at(p));
        };
        EXPECT_LT(std::tuple(patch(a), a.y(), a.x()), std::tuple(patch(b), b.y(), b.x()));
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const Candidate& c = r.candidates[own + i];
        EXPECT_EQ(c.kind, i < 2 ? required : existing);
        EXPECT_EQ(c.at, i < 2 ? site.options.required[i] : site.options.existing[i - 2]);
        EXPECT_EQ(c.cell, -1);
        EXPECT_FLOAT_EQ(c.vf_rad, static_cast<float>(site.world->vf_rad(c.at)));
        const CoverageRow row = site.world->row(c.at);
        EXPECT_EQ(r.table.begin[own + i + 1] - r.table.begin[own + i],
                  static_cast<std::int64_t>(row.size()));
    }
}

}  // namespace
}  // namespace vfplan
