// Measures of plans made by hand, with values worked out by hand (docs/method.md 7).
#include "engine/plan/metrics.h"

#include <gtest/gtest.h>

#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

using test::hand_made;
using test::HandMade;

// A plan of stations = candidates, in the networks named, with links as given.
Plan plan_with(const std::vector<std::int32_t>& networks, const std::vector<OverlapPair>& links,
               std::vector<PieceStatus> pieces = {}) {
    Plan plan;
    for (std::size_t i = 0; i < networks.size(); ++i) {
        Station s;
        s.candidate = static_cast<std::int32_t>(i);
        s.network = networks[i];
        plan.stations.push_back(s);
    }
    for (const OverlapPair& l : links) plan.links.push_back({l.from, l.to, l.overlap, {}});
    plan.pieces = std::move(pieces);
    return plan;
}

// Pieces without stations, or stations that see nothing: the graph alone.
Metrics of_graph(const std::vector<std::int32_t>& networks, const std::vector<OverlapPair>& links,
                 int threads = 1) {
    const HandMade h = hand_made({}, std::vector<std::vector<std::int32_t>>(networks.size()), {});
    return measure(Threads(threads), h.input(), plan_with(networks, links), h.places({}), 10);
}

TEST(Wapl, OneStationAndNone) {
    for (const std::size_t n : {0U, 1U}) {
        const Metrics m = of_graph(std::vector<std::int32_t>(n, 0), {});
        EXPECT_EQ(m.wapl, 0);
        EXPECT_EQ(m.wapl_penalty100, 0);
        EXPECT_EQ(m.disconnected_pairs, 0);
        EXPECT_EQ(m.networks, static_cast<std::int64_t>(n));
        EXPECT_EQ(m.bottleneck_overlap, 0);
        EXPECT_EQ(m.redundant_links, 0);
    }
}

TEST(Wapl, MeanOfShortestPathsWithOneMinusOverlap) {
    // 0 - 1 - 2: paths 0.5, 0.2 and 0.7.
    const Metrics path = of_graph({0, 0, 0}, {{0, 1, 0.5}, {1, 2, 0.8}});
    EXPECT_DOUBLE_EQ(path.wapl, 1.4 / 3);
    EXPECT_DOUBLE_EQ(path.wapl_penalty100, 1.4 / 3);
    // The direct link 0 - 2 of weight 0.9 is longer than the path over 1, one of 0.6 is shorter.
    EXPECT_DOUBLE_EQ(of_graph({0, 0, 0}, {{0, 1, 0.5}, {0, 2, 0.1}, {1, 2, 0.8}}).wapl, 1.4 / 3);
    EXPECT_DOUBLE_EQ(of_graph({0, 0, 0}, {{0, 1, 0.5}, {0, 2, 0.4}, {1, 2, 0.8}}).wapl, 1.3 / 3);
    EXPECT_EQ(of_graph({0, 0}, {{0, 1, 1}}).wapl, 0);
}

TEST(Wapl, PairsWithoutPathAreCountedApartAndPenalised) {
    const Metrics m = of_graph({0, 0, 0, 1, 1}, {{0, 1, 0.5}, {1, 2, 0.8}, {3, 4, 0.7}});
    EXPECT_EQ(m.networks, 2);
    EXPECT_EQ(m.disconnected_pairs, 6);
    EXPECT_DOUBLE_EQ(m.wapl, (1.4 + 0.3) / 4);
    EXPECT_DOUBLE_EQ(m.wapl_penalty100, (1.4 + 0.3 + 600) / 10);
    const Metrics apart = of_graph({0, 1}, {});
    EXPECT_EQ(apart.wapl, 0);
    EXPECT_EQ(apart.wapl_penalty100, 100);
    EXPECT_EQ(apart.disconnected_pairs, 1);
}

TEST(Wapl, ThreadsChangeNothing) {
    const HandMade h = test::random_hand_made(5, 60, 1);
    std::vector<OverlapPair> links;
    for (std::int32_t v = 0; v < h.graph.size(); ++v) {
        h.graph.each(v, [&](std::int32_t n, double o) {
            if (n > v) links.push_back({v, n, o});
        });
    }
    const std::vector<std::int32_t> one_network(60, 0);
    EXPECT_EQ(of_graph(one_network, links, 1).wapl, of_graph(one_network, links, 2).wapl);
    EXPECT_GT(of_graph(one_network, links, 2).wapl, 0);
}

// A ring seen from any station is the same ring: a sample says what all say, without error.
TEST(Wapl, ASampleOfARingIsExact) {
    std::vector<OverlapPair> ring;
    for (std::int32_t v = 0; v + 1 < 30; ++v) ring.push_back({v, v + 1, 0.5});
    ring.insert(ring.begin() + 1, {0, 29, 0.5});
    const Graph graph = make_graph(30, ring);
    const PathMeasures all = measure_paths(Threads(1), graph, 30);
    const PathMeasures some = measure_paths(Threads(2), graph, 7);
    EXPECT_EQ(all.sources, 30);
    EXPECT_EQ(all.standard_error, 0);
    EXPECT_EQ(some.sources, 7);
    EXPECT_DOUBLE_EQ(some.wapl, all.wapl);
    EXPECT_DOUBLE_EQ(some.wapl_penalty100, all.wapl_penalty100);
    EXPECT_NEAR(some.standard_error, 0, 1e-12);
}

TEST(Wapl, ASampleIsAsFarOffAsItSays) {
    double beyond = 0;
    for (int seed = 0; seed < 20; ++seed) {
        const HandMade h = test::random_hand_made(seed, 80, 1);
        const PathMeasures all = measure_paths(Threads(1), h.graph, 80);
        const PathMeasures some = measure_paths(Threads(1), h.graph, 25);
        EXPECT_EQ(some.disconnected_pairs, all.disconnected_pairs);
        EXPECT_GT(some.standard_error, 0);
        beyond += std::abs(some.wapl - all.wapl) > 2 * some.standard_error ? 1 : 0;
    }
    EXPECT_LE(beyond, 4);
}

TEST(Network, BottleneckIsTheWeakestOfTheBestTree) {
    // The cycle's weakest link 0.3 can be done without; 0.4 then is the weakest.
    EXPECT_EQ(of_graph({0, 0, 0, 0}, {{0, 1, 0.9}, {0, 3, 0.3}, {1, 2, 0.4}, {2, 3, 0.8}})
                  .bottleneck_overlap,
              0.4);
    // Where a bridge is weaker, that is it; other networks do not count.
    EXPECT_EQ(of_graph({0, 0, 0, 0, 1, 1},
                       {{0, 1, 0.9}, {0, 2, 0.7}, {1, 2, 0.8}, {2, 3, 0.35}, {4, 5, 0.31}})
                  .bottleneck_overlap,
              0.35);
    EXPECT_EQ(of_graph({0, 1, 1}, {{1, 2, 0.5}}).bottleneck_overlap, 0);
}

TEST(Network, BridgesArticulationAndRedundancy) {
    // A triangle 0 1 2, a tail 2 - 3 - 4, and a pair 5 - 6.
    const Metrics m =
        of_graph({0, 0, 0, 0, 0, 1, 1},
                 {{0, 1, 0.5}, {0, 2, 0.5}, {1, 2, 0.5}, {2, 3, 0.5}, {3, 4, 0.5}, {5, 6, 0.5}});
    EXPECT_EQ(m.bridges, 3);
    EXPECT_EQ(m.articulation_stations, 2);
    EXPECT_EQ(m.redundant_links, 6 - 7 + 2);
    const Metrics full =
        of_graph({0, 0, 0, 0}, {{0, 1, 1}, {0, 2, 1}, {0, 3, 1}, {1, 2, 1}, {1, 3, 1}, {2, 3, 1}});
    EXPECT_EQ(full.bridges, 0);
    EXPECT_EQ(full.articulation_stations, 0);
    EXPECT_EQ(full.redundant_links, 3);
}

TEST(Pieces, CoverageByCountAndByLength) {
    using enum PieceStatus;
    const HandMade h = hand_made({1, 2, 4, 8, 16}, {{0, 1}, {2}}, {});
    const std::vector<Wall> walls(5, {Vec2d(0, 0), Vec2d(1, 0)});
    const Metrics m =
        measure(Threads(1), h.input(),
                plan_with({0, 1}, {}, {covered, covered, unreached, no_viewpoint, off_candidates}),
                h.places(walls), 10);
    EXPECT_EQ(m.pieces_coverable, 4);
    EXPECT_EQ(m.pieces_covered, 2);
    EXPECT_EQ(m.pieces_unreached, 1);
    EXPECT_EQ(m.length_all_m, 31);
    EXPECT_EQ(m.length_coverable_m, 23);
    EXPECT_EQ(m.length_covered_m, 3);
}

TEST(Pieces, HowManyStationsSeeEach) {
    // Piece 0 is seen by all twelve stations, piece 1 by two, piece 2 by one, piece 3 by none.
    std::vector<std::vector<std::int32_t>> rows(12, {0});
    rows[3] = {0, 1};
    rows[7] = {0, 1, 2};
    const HandMade h = hand_made({1, 1, 1, 1}, rows, {});
    const std::vector<Wall> walls(4, {Vec2d(1, 1), Vec2d(2, 1)});
    Plan plan = plan_with(std::vector<std::int32_t>(12, 0), {}, h.status);
    std::vector<std::int64_t> want = {1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 1};
    EXPECT_EQ(measure(Threads(1), h.input(), plan, h.places(walls), 10).multiplicity, want);
    plan.stations.resize(9);  // candidates 0 to 8
    want = {1, 1, 1, 0, 0, 0, 0, 0, 0, 1, 0};
    EXPECT_EQ(measure(Threads(1), h.input(), plan, h.places(walls), 10).multiplicity, want);
}

// Histograms of one station at the origin that sees walls of 2 m; `mid`: their middles.
Metrics from_origin(const std::vector<Vec2d>& middles, const std::vector<Vec2d>& along) {
    std::vector<std::int32_t> row;
    std::vector<Wall> walls;
    for (std::size_t i = 0; i < middles.size(); ++i) {
        row.push_back(static_cast<std::int32_t>(i));
        walls.push_back({middles[i] - along[i], middles[i] + along[i]});
    }
    const HandMade h = hand_made(std::vector<double>(middles.size(), 2), {row}, {});
    return measure(Threads(1), h.input(), plan_with({0}, {}, h.status), h.places(walls), 50);
}

TEST(Pieces, RangesByTenthsOfTheLargest) {
    const Metrics m = from_origin({{0, 4}, {0, 6}, {0, 24}, {0, 49}, {0, 50}, {0, 50.5}},
                                  std::vector<Vec2d>(6, Vec2d(1, 0)));
    EXPECT_EQ(m.range_tenths, (std::vector<std::int64_t>{1, 1, 0, 0, 1, 0, 0, 0, 0, 3}));
}

TEST(Pieces, IncidenceByTensOfDegrees) {
    const auto at_deg = [](double deg) {
        const double a = deg * 3.14159265358979323846 / 180;
        return Vec2d(20 * std::sin(a), 20 * std::cos(a));
    };
    // Beams to walls along x: the angle to the normal is that to the y axis, on either side.
    const Metrics m = from_origin(
        {at_deg(0), at_deg(4), at_deg(-14), at_deg(45), at_deg(135), at_deg(89), at_deg(-89.9)},
        std::vector<Vec2d>(7, Vec2d(-1, 0)));
    EXPECT_EQ(m.incidence_tens, (std::vector<std::int64_t>{2, 1, 0, 0, 2, 0, 0, 0, 2}));
    // Pieces, not walls, are measured: the far end of a wall is seen at a grazing angle.
    const HandMade h = hand_made(std::vector<double>(10, 10.0), {{0, 9}}, {});
    const std::vector<Wall> walls = {{Vec2d(-5, 10), Vec2d(95, 10)}};
    Pieces ten;
    ten.add_wall(100, 10, 0);
    const Metrics long_wall =
        measure(Threads(1), h.input(), plan_with({0}, {}, h.status), PiecePlaces(walls, ten), 100);
    EXPECT_EQ(long_wall.incidence_tens, (std::vector<std::int64_t>{1, 0, 0, 0, 0, 0, 0, 0, 1}));
    EXPECT_EQ(long_wall.range_tenths, (std::vector<std::int64_t>{0, 1, 0, 0, 0, 0, 0, 0, 0, 1}));
}

TEST(Bound, GapIsTheShareThatMightBeSpared) {
    const HandMade h = hand_made({1, 1}, {{0}, {1}, {}, {}}, {});
    Plan plan = plan_with({0, 0, 0, 0}, {}, h.status);
    plan.certificate.networks.resize(2);
    plan.certificate.networks[0].bound = 2;
    plan.certificate.networks[1].bound = 1;
    const std::vector<Wall> walls(2, {Vec2d(1, 1), Vec2d(2, 1)});
    const Metrics m = measure(Threads(1), h.input(), plan, h.places(walls), 10);
    EXPECT_EQ(m.lower_bound, 3);
    EXPECT_DOUBLE_EQ(gap(4, m.lower_bound), 0.25);
    EXPECT_EQ(gap(0, 0), 0);
}

}  // namespace
}  // namespace vfplan
