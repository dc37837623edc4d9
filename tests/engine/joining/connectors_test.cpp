// Candidates that join components of the overlap graph (docs/method.md 6).
#include <gtest/gtest.h>

#include "kernels/index.h"
#include "tests/engine/plan/table_graph.h"
#include "tests/engine/tables/ground.h"

namespace vfplan {
namespace {

using test::box_ring;
using test::CandidateOptions;
using test::CandidateResult;
using test::cells_of;
using test::ring_of;
using test::wall;
using test::World;
using enum CandidateKind;

// Rooms of 10 x 10 m in a row, with doors in the walls between them.
struct Rooms {
    static std::vector<Wall> walls_with_doors(int rooms, double from, double to) {
        std::vector<Wall> out;
        for (int i = 1; i < rooms; ++i) {
            out.push_back(wall({10. * i, 0}, {10. * i, from}));
            out.push_back(wall({10. * i, to}, {10. * i, 10}));
        }
        return out;
    }
    Rooms(int rooms, double from, double to, World::Setting s = {})
        : world(s, {outline(rooms)}, walls_with_doors(rooms, from, to)) {
        for (int i = 0; i < rooms; ++i) {
            lines.push_back({{10. * i + 3, 8}, {10. * i + 7, 8}});
        }
    }
    // With corners where the walls between the rooms begin.
    static Ring outline(int rooms) {
        Ring ring;
        for (int i = 0; i <= rooms; ++i) ring.emplace_back(10. * i, 0);
        for (int i = rooms; i >= 0; --i) ring.emplace_back(10. * i, 10);
        return ring;
    }
    CandidateResult candidates(double threshold, int threads = 1) const {
        CandidateOptions o;
        o.threshold = threshold;
        return world.candidates(world.drawn(lines), o, threads);
    }
    World world;
    std::vector<std::vector<std::pair<double, double>>> lines;
};

std::int64_t components_in(const World& w, const CandidateResult& r, double threshold) {
    const auto component = components(
        test::graph_of(Threads(1), w.pieces, r.table, {OverlapRatio::mean_len, threshold}));
    return 1 + *std::max_element(component.begin(), component.end());
}

TEST(Connectors, RoomsWithDoorsBecomeOneComponent) {
    for (const int rooms : {2, 3, 4}) {
        const Rooms r(rooms, 1, 3);
        const CandidateResult found = r.candidates(0.4);
        EXPECT_EQ(found.components_before, rooms);
        EXPECT_EQ(found.components, 1);
        EXPECT_EQ(components_in(r.world, found, 0.4), 1);
        EXPECT_GE(cells_of(found.candidates, connector).size(), idx(rooms - 1));
        const CandidateResult two = r.candidates(0.4, 2);
        ASSERT_EQ(two.candidates.size(), found.candidates.size());
        for (std::size_t i = 0; i < two.candidates.size(); ++i) {
            EXPECT_EQ(two.candidates[i].at, found.candidates[i].at);
        }
    }
}

TEST(Connectors, NothingToJoinAddsNothing) {
    const Rooms r(1, 1, 3);
    const CandidateResult found = r.candidates(0.4);
    EXPECT_EQ(found.components_before, 1);
    EXPECT_EQ(found.components, 1);
    EXPECT_TRUE(cells_of(found.candidates, connector).empty());
}

// Every connector stands free, and sees what is written of it.
void expect_free(const World& w, const CandidateResult& found) {
    for (std::size_t i = 0; i < found.candidates.size(); ++i) {
        const Candidate& c = found.candidates[i];
        if (c.kind != connector) continue;
        EXPECT_TRUE(w.free_at(c.at)) << c.at.transpose();
        if (c.cell >= 0) {
            EXPECT_EQ(c.at, w.grid.centre(c.cell));
            EXPECT_NE(w.standable[idx(c.cell)], 0);
            EXPECT_GT(w.field[idx(c.cell)], 0);
        }
        EXPECT_EQ(c.vf_rad, static_cast<float>(w.vf_rad(c.at)));
        EXPECT_EQ(found.table.begin[i + 1] - found.table.begin[i],
                  static_cast<std::int64_t>(w.row(c.at).size()));
        EXPECT_FALSE(w.row(c.at).empty());
    }
}

TEST(Connectors, PointsBetweenCellsStandInTheDoor) {
    // Through a narrow door what is seen changes much from one cell to the next.
    World::Setting s;
    s.visible_fraction = 0.3;
    int between = 0;
    for (const double width : {0.3, 0.6, 1.2, 1.8}) {
        for (const double tau : {0.5, 0.6, 0.7, 0.8}) {
            const Rooms r(2, 2.4997 - width / 2, 2.4997 + width / 2, s);
            const CandidateResult found = r.candidates(tau);
            expect_free(r.world, found);
            EXPECT_EQ(found.components, components_in(r.world, found, tau));
            for (const Candidate& c : found.candidates) {
                if (c.kind != connector || c.cell >= 0) continue;
                ++between;
                EXPECT_EQ(found.components, 1);  // a path that fails adds nothing
                EXPECT_GT(c.at.x(), 9);
                EXPECT_LT(c.at.x(), 11);
                EXPECT_LT(std::abs(c.at.y() - 2.4997), 1 + width / 2);
            }
        }
    }
    EXPECT_GT(between, 3);
}

TEST(Connectors, StandsOfAPathOverlapOneAfterAnother) {
    // A lane with three bends between two halls.
    World::Setting s;
    s.scanner.range_max_m = 8;
    const World w(s, {ring_of({{0, 0},
                               {10, 0},
                               {10, 4},
                               {20, 4},
                               {20, 18},
                               {30, 18},
                               {30, 8},
                               {40, 8},
                               {40, 22},
                               {30, 22},
                               {30, 20},
                               {17, 20},
                               {17, 6},
                               {10, 6},
                               {10, 10},
                               {0, 10}})});
    const auto g = w.drawn({{{3, 5}, {7, 5}}, {{35, 12}, {35, 18}}});
    for (const double tau : {0.3, 0.6}) {
        CandidateOptions o;
        o.threshold = tau;
        const CandidateResult found = w.candidates(g, o);
        EXPECT_GT(found.components_before, 1);
        EXPECT_EQ(found.components, 1);
        EXPECT_EQ(components_in(w, found, tau), 1);
        expect_free(w, found);
    }
}

TEST(Connectors, AnEnclosedCourtyardStaysApartAndAddsNothing) {
    const World w({}, {box_ring(0, 0, 40, 40), box_ring(10, 10, 30, 30), box_ring(14, 14, 26, 26)});
    const CandidateResult found =
        w.candidates(w.drawn({{{5, 5}, {35, 5}}, {{18, 20}, {22, 20}}, {{5, 35}, {35, 35}}}), {});
    EXPECT_EQ(found.components, 2);
    EXPECT_EQ(components_in(w, found, 0.3), 2);
    for (const Candidate& c : found.candidates) {
        if (c.kind != connector) continue;
        EXPECT_FALSE(c.at.x() > 13 && c.at.x() < 27 && c.at.y() > 13 && c.at.y() < 27);
    }
    const World alone({}, {box_ring(0, 0, 30, 10), box_ring(10, 1, 20, 9), box_ring(12, 3, 18, 7)});
    const CandidateResult apart =
        alone.candidates(alone.drawn({{{4, 5}, {6, 5}}, {{14, 5}, {16, 5}}}), {});
    EXPECT_GE(apart.components_before, 2);
}

TEST(Connectors, APathOnWhichTheViewJumpsAddsNothing) {
    // A gap of 1 cm: behind it the other room is seen only from within it.
    const Rooms r(2, 2.4947, 2.5047);
    const CandidateResult found = r.candidates(0.9);
    EXPECT_EQ(found.components_before, 2);
    EXPECT_EQ(found.components, 2);
    EXPECT_TRUE(cells_of(found.candidates, connector).empty());
}

TEST(Connectors, AFailedPathAddsNothingBesideAGoodOne) {
    // A long hall, split on the path, with a gap of 1 cm at its far end; a wide door at the near
    // one.
    World::Setting s;
    s.scanner.range_max_m = 12;
    const World w(
        s, {ring_of({{0, 0}, {10, 0}, {50, 0}, {60, 0}, {60, 10}, {50, 10}, {10, 10}, {0, 10}})},
        {wall({10, 0}, {10, 1}), wall({10, 7}, {10, 10}), wall({50, 0}, {50, 4.4947}),
         wall({50, 4.5047}, {50, 10})});
    const auto g = w.drawn({{{3, 5}, {6, 5}}, {{13, 5}, {16, 5}}, {{53, 5}, {56, 5}}});
    CandidateOptions o;
    o.threshold = 0.85;
    const CandidateResult found = w.candidates(g, o);
    EXPECT_FALSE(cells_of(found.candidates, connector).empty());
    EXPECT_GT(found.components, 1);
    std::int64_t beyond = 0;  // only rescues stand there
    for (const Candidate& c : found.candidates)
        beyond += c.kind == connector && c.at.x() > 45 ? 1 : 0;
    EXPECT_EQ(beyond, 0);
}

TEST(Connectors, PathsLeadOverCellsThatSeeSomething) {
    Rooms r(2, 1, 3);
    for (std::int32_t y = 0; y < r.world.grid.ny; ++y) {  // blind before the wall
        auto& vf = r.world.field[idx(r.world.grid.id(9, y))];
        if (vf > 0) vf = 0;
    }
    const CandidateResult found = r.candidates(0.4);
    EXPECT_EQ(found.components_before, 2);
    EXPECT_EQ(found.paths, 0U);
    EXPECT_EQ(found.components, 1);  // over cells elsewhere
}

TEST(Connectors, PathsLeadOverCellsWhereAStationMayStand) {
    Rooms r(2, 1, 3);
    for (std::int32_t y = 0; y < r.world.grid.ny; ++y)
        r.world.standable[idx(r.world.grid.id(10, y))] = 0;
    EXPECT_EQ(r.candidates(0.4).paths, 0U);
    Rooms walled(2, 1, 3);
    for (std::int32_t y = 0; y < walled.world.grid.ny; ++y) {
        auto& here = walled.world.closed[idx(walled.world.grid.id(9, y))];
        auto& there = walled.world.closed[idx(walled.world.grid.id(10, y))];
        here = static_cast<std::uint8_t>(here | 0x83U);    // no steps to the east
        there = static_cast<std::uint8_t>(there | 0x38U);  // nor back
    }
    EXPECT_EQ(walled.candidates(0.4).paths, 0U);
    EXPECT_GT(Rooms(2, 1, 3).candidates(0.4).paths, 0U);
}

}  // namespace
}  // namespace vfplan
