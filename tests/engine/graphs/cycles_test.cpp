// Cycles of a growing network must be those of the network as it stands.
#include "engine/graphs/cycles.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "engine/graphs/cuts.h"
#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

void expect_cycles_of(const Graph& graph, std::vector<std::int32_t> nodes, Cycles& cycles) {
    std::sort(nodes.begin(), nodes.end());
    const Cuts cuts = find_cuts(induced(graph, nodes));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        EXPECT_EQ(cycles.on_cycle(nodes[i]), cuts.on_cycle[i] != 0);
    }
}

TEST(Cycles, AgreeWithTheCutsOfTheWholeNetworkNodeByNode) {
    int loose = 0;
    int closed = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        const auto nodes = static_cast<std::int32_t>(10 + seed % 50);
        // Few links beside the tree.
        std::mt19937_64 random(seed);
        std::vector<OverlapPair> edges;
        for (std::int32_t b = 1; b < nodes; ++b) {
            const auto a = static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(b));
            for (std::int32_t k = 0; k < b; ++k) {
                if (k == a || random() % 60 == 0) edges.push_back({k, b, 0.5});
            }
        }
        std::sort(edges.begin(), edges.end(), [](const OverlapPair& p, const OverlapPair& q) {
            return std::pair(p.from, p.to) < std::pair(q.from, q.to);
        });
        const Graph graph = make_graph(nodes, edges);
        // A network at once, then what touches it one by one. Nodes hang on lower ones.
        Cycles cycles(graph);
        std::vector<std::int32_t> inside;
        for (std::int32_t v = 0; v < nodes / 2; ++v) inside.push_back(v);
        std::vector<std::int32_t> shuffled = inside;
        std::shuffle(shuffled.begin(), shuffled.end(), random);
        cycles.add_network(shuffled);
        expect_cycles_of(graph, inside, cycles);
        for (std::int32_t v = nodes / 2; v < nodes; ++v) {
            EXPECT_FALSE(cycles.inside(v));
            cycles.add(v);
            EXPECT_TRUE(cycles.inside(v));
            inside.push_back(v);
            expect_cycles_of(graph, inside, cycles);
        }
        for (const std::int32_t v : inside) ++(cycles.on_cycle(v) ? closed : loose);
    }
    EXPECT_GT(loose, 300);
    EXPECT_GT(closed, 300);
}

TEST(Cycles, NetworksDoNotMix) {
    // A triangle and a path.
    const Graph graph = make_graph(6, {{0, 2, 1}, {0, 4, 1}, {1, 3, 1}, {2, 4, 1}, {3, 5, 1}});
    Cycles cycles(graph);
    cycles.add_network({4, 0, 2});
    cycles.add_network({1, 5, 3});
    for (const std::int32_t v : {0, 2, 4}) EXPECT_TRUE(cycles.on_cycle(v));
    for (const std::int32_t v : {1, 3, 5}) EXPECT_FALSE(cycles.on_cycle(v));
}

}  // namespace
}  // namespace vfplan
