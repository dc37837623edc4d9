#include "engine/graphs/graph.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "engine/graphs/cuts.h"
#include "tests/engine/plan/table_graph.h"

namespace vfplan {
namespace {

// Each pair with probability `density`.
std::vector<OverlapPair> random_pairs(std::mt19937_64& random, std::int32_t nodes, double density) {
    std::uniform_real_distribution<double> number(0, 1);
    std::vector<OverlapPair> pairs;
    for (std::int32_t a = 0; a < nodes; ++a) {
        for (std::int32_t b = a + 1; b < nodes; ++b) {
            if (number(random) < density) pairs.push_back({a, b, number(random)});
        }
    }
    return pairs;
}

// Components by repeated relabelling, without the nodes and edges that `skip` names.
template <class Skip>
int count_parts(std::int32_t nodes, const std::vector<OverlapPair>& pairs, std::int32_t without,
                Skip&& skip) {
    std::vector<std::int32_t> label(static_cast<std::size_t>(nodes));
    for (std::size_t v = 0; v < label.size(); ++v) label[v] = static_cast<std::int32_t>(v);
    for (bool changed = true; changed;) {
        changed = false;
        for (const OverlapPair& p : pairs) {
            if (p.from == without || p.to == without || skip(p)) continue;
            auto& a = label[static_cast<std::size_t>(p.from)];
            auto& b = label[static_cast<std::size_t>(p.to)];
            if (a == b) continue;
            a = b = std::min(a, b);
            changed = true;
        }
    }
    std::set<std::int32_t> labels(label.begin(), label.end());
    if (without >= 0) labels.erase(label[static_cast<std::size_t>(without)]);
    return static_cast<int>(labels.size());
}

constexpr auto none = [](const OverlapPair&) { return false; };

TEST(Graph, NeighboursAscendOnBothEnds) {
    std::mt19937_64 random(1);
    const auto pairs = random_pairs(random, 40, 0.2);
    const Graph g = make_graph(40, pairs);
    EXPECT_EQ(g.size(), 40);
    EXPECT_EQ(g.edges(), static_cast<std::int64_t>(pairs.size()));
    std::size_t seen = 0;
    for (std::int32_t v = 0; v < 40; ++v) {
        std::int32_t last = -1;
        g.each(v, [&](std::int32_t n, double overlap) {
            EXPECT_GT(n, last);
            last = n;
            for (const OverlapPair& p : pairs) {
                if (p.from != std::min(v, n) || p.to != std::max(v, n)) continue;
                EXPECT_EQ(p.overlap, overlap);
                ++seen;
            }
        });
    }
    EXPECT_EQ(seen, 2 * pairs.size());
}

TEST(Graph, EmptyAndLonely) {
    EXPECT_EQ(make_graph(0, {}).size(), 0);
    const Graph g = make_graph(3, {});
    EXPECT_EQ(components(g), (std::vector<std::int32_t>{0, 1, 2}));
    EXPECT_EQ(find_cuts(g).bridges, 0);
}

TEST(Graph, InducedPartKeepsItsEdges) {
    std::mt19937_64 random(2);
    const auto pairs = random_pairs(random, 30, 0.25);
    const std::vector<std::int32_t> nodes = {0, 3, 4, 9, 15, 16, 22, 28};
    const Graph part = induced(make_graph(30, pairs), nodes);
    std::int64_t want = 0;
    for (const OverlapPair& p : pairs) {
        const auto a = std::find(nodes.begin(), nodes.end(), p.from);
        const auto b = std::find(nodes.begin(), nodes.end(), p.to);
        if (a == nodes.end() || b == nodes.end()) continue;
        ++want;
        bool found = false;
        part.each(static_cast<std::int32_t>(a - nodes.begin()), [&](std::int32_t n, double o) {
            found = found || (n == b - nodes.begin() && o == p.overlap);
        });
        EXPECT_TRUE(found);
    }
    EXPECT_GT(want, 3);
    EXPECT_EQ(part.edges(), want);
}

TEST(Graph, ComponentsAreNumberedByTheirFirstNode) {
    const Graph g = make_graph(6, {{0, 4, 1}, {1, 2, 1}, {2, 5, 1}});
    EXPECT_EQ(components(g), (std::vector<std::int32_t>{0, 1, 1, 2, 0, 1}));
}

TEST(Graph, ComponentsBridgesAndArticulationEqualBruteForce) {
    std::mt19937_64 random(3);
    std::int64_t bridges = 0;
    for (int i = 0; i < 150; ++i) {
        const std::int32_t n = 2 + i % 17;
        const auto pairs = random_pairs(random, n, 1.6 / n + 0.001 * i);
        const Graph g = make_graph(n, pairs);
        const auto number = components(g);
        const int parts = count_parts(n, pairs, -1, none);
        EXPECT_EQ(*std::max_element(number.begin(), number.end()) + 1, parts);
        for (const OverlapPair& p : pairs) {
            EXPECT_EQ(number[static_cast<std::size_t>(p.from)],
                      number[static_cast<std::size_t>(p.to)]);
        }

        const Cuts cuts = find_cuts(g);
        std::vector<std::uint8_t> on_cycle(static_cast<std::size_t>(n), 0);
        std::int64_t want = 0;
        for (const OverlapPair& p : pairs) {
            const bool bridge = count_parts(n, pairs, -1, [&](const OverlapPair& q) {
                                    return q.from == p.from && q.to == p.to;
                                }) > parts;
            want += bridge ? 1 : 0;
            if (!bridge) {
                on_cycle[static_cast<std::size_t>(p.from)] = 1;
                on_cycle[static_cast<std::size_t>(p.to)] = 1;
            }
        }
        EXPECT_EQ(cuts.bridges, want);
        EXPECT_EQ(cuts.on_cycle, on_cycle);
        bridges += want;

        // Some edges twice.
        std::vector<OverlapPair> more;
        for (const OverlapPair& p : pairs) {
            more.push_back(p);
            if (random() % 3 == 0) continue;
            more.push_back(p);
            want -= count_parts(n, pairs, -1, [&](const OverlapPair& q) {
                        return q.from == p.from && q.to == p.to;
                    }) > parts;
            on_cycle[static_cast<std::size_t>(p.from)] = 1;
            on_cycle[static_cast<std::size_t>(p.to)] = 1;
        }
        const Cuts with_twins = find_cuts(make_graph(n, more));
        EXPECT_EQ(with_twins.bridges, want);
        EXPECT_EQ(with_twins.on_cycle, on_cycle);
        for (std::int32_t v = 0; v < n; ++v) {
            bool lonely = true;
            g.each(v, [&](std::int32_t, double) { lonely = false; });
            const int others = parts - (lonely ? 1 : 0);
            EXPECT_EQ(cuts.articulation[static_cast<std::size_t>(v)],
                      count_parts(n, pairs, v, none) > others ? 1 : 0);
            EXPECT_EQ(cuts.lesser_part[static_cast<std::size_t>(v)] > 0,
                      cuts.articulation[static_cast<std::size_t>(v)] != 0);
        }
    }
    EXPECT_GT(bridges, 100);
}

TEST(Graph, TheLesserPartIsTheSecondLargest) {
    // A triangle 0 1 2; at 2 hang 3 and a path 4 5; 6 - 7 apart.
    const Graph g = make_graph(
        8, {{0, 1, 1}, {0, 2, 1}, {1, 2, 1}, {2, 3, 1}, {2, 4, 1}, {4, 5, 1}, {6, 7, 1}});
    EXPECT_EQ(find_cuts(g).lesser_part, (std::vector<std::int32_t>{0, 0, 2, 0, 1, 0, 0, 0}));
    // The same from the other end.
    const Graph h = make_graph(
        8, {{0, 1, 1}, {2, 3, 1}, {3, 5, 1}, {4, 5, 1}, {5, 6, 1}, {5, 7, 1}, {6, 7, 1}});
    EXPECT_EQ(find_cuts(h).lesser_part, (std::vector<std::int32_t>{0, 0, 0, 1, 0, 2, 0, 0}));
}

TEST(Graph, OverlapGraphIsThatOfAllPairsOnAnyNumberOfThreads) {
    std::mt19937_64 random(4);
    Pieces pieces;
    for (int p = 0; p < 200; ++p) pieces.add_wall(0.1 + 0.01 * p, 1, 0);
    CoverageTable table;
    std::vector<OverlapRow> own;
    for (int r = 0; r < 700; ++r) {  // more than one block
        CoverageRow row;
        for (std::int32_t p = r / 4; p < std::min(200, r / 4 + 20); ++p) {
            const float angle_rad = 0.01F * static_cast<float>(1 + random() % 30);
            if (random() % 2 != 0) row.push_back({p, 1, angle_rad});
        }
        table.add(row);
        own.emplace_back(row, pieces);
    }
    for (const OverlapFormula& f : overlap_ratios) {
        for (const double threshold : {0.0, 0.3}) {
            const Graph one = test::graph_of(Threads(1), pieces, table, {f.ratio, threshold});
            const Graph two = test::graph_of(Threads(2), pieces, table, {f.ratio, threshold});
            const Graph some = test::graph_of(Threads(2), pieces, table, {f.ratio, threshold}, 900);
            for (const Graph* other : {&two, &some}) {
                EXPECT_EQ(one.begin, other->begin);
                EXPECT_EQ(one.to, other->to);
                EXPECT_EQ(one.overlap, other->overlap);
            }
            std::vector<OverlapPair> pairs;
            for (std::size_t a = 0; a < own.size(); ++a) {
                for (std::size_t b = a + 1; b < std::min(own.size(), a + 120); ++b) {
                    const double o = overlap(f.ratio, own[a], own[b]);
                    if (o <= 0 || o < threshold - 1e-12) continue;
                    pairs.push_back(
                        {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), o});
                }
            }
            const Graph want = make_graph(static_cast<std::int32_t>(own.size()), pairs);
            EXPECT_EQ(one.to, want.to) << f.name << " " << threshold;
            EXPECT_EQ(one.overlap, want.overlap) << f.name << " " << threshold;
            EXPECT_GT(one.edges(), 100);
        }
    }
}

}  // namespace
}  // namespace vfplan
