// Looking around one node must say what the cuts of the whole network say.
#include "engine/graphs/separation.h"

#include <gtest/gtest.h>

#include <random>

#include "engine/graphs/cuts.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

Graph random_graph(std::int32_t nodes, int edges, std::mt19937_64& random) {
    std::vector<std::uint8_t> joined(idx(nodes) * idx(nodes), 0);
    for (int e = 0; e < edges; ++e) {
        const auto a = static_cast<std::int32_t>(random() % idx(nodes));
        const auto b = static_cast<std::int32_t>(random() % idx(nodes));
        if (a != b) joined[idx(std::min(a, b)) * idx(nodes) + idx(std::max(a, b))] = 1;
    }
    std::vector<OverlapPair> pairs;
    for (std::int32_t a = 0; a < nodes; ++a) {
        for (std::int32_t b = a + 1; b < nodes; ++b) {
            if (joined[idx(a) * idx(nodes) + idx(b)] != 0) pairs.push_back({a, b, 0.5});
        }
    }
    return make_graph(nodes, pairs);
}

TEST(Separation, AgreesWithTheCutsOfTheWholeNetwork) {
    std::mt19937_64 random(11);
    int cuts_seen = 0;
    for (int round = 0; round < 400; ++round) {
        const auto nodes = static_cast<std::int32_t>(4 + random() % 30);
        const Graph graph =
            random_graph(nodes, static_cast<int>(idx(nodes) * (1 + random() % 3)), random);
        std::vector<std::uint8_t> inside(idx(nodes), 0);
        std::vector<std::int32_t> chosen;
        for (std::int32_t v = 0; v < nodes; ++v) {
            inside[idx(v)] = random() % 4 != 0 ? 1 : 0;
            if (inside[idx(v)] != 0) chosen.push_back(v);
        }
        const Cuts cuts = find_cuts(induced(graph, chosen));
        Separation around(graph, inside);
        for (std::size_t i = 0; i < chosen.size(); ++i) {
            EXPECT_EQ(around.can_go(chosen[i]), cuts.articulation[i] == 0);
            cuts_seen += cuts.articulation[i];
        }
    }
    EXPECT_GT(cuts_seen, 100);
}

TEST(Separation, FollowsWhatComesAndGoes) {
    // A ring of six: nobody cuts it; without node 0 it is a path, whose ends may go.
    std::vector<OverlapPair> pairs;
    for (std::int32_t v = 0; v + 1 < 6; ++v) pairs.push_back({v, v + 1, 0.5});
    pairs.push_back({0, 5, 0.5});
    std::sort(pairs.begin(), pairs.end(), [](const OverlapPair& a, const OverlapPair& b) {
        return std::pair(a.from, a.to) < std::pair(b.from, b.to);
    });
    const Graph ring = make_graph(6, pairs);
    Separation around(ring, std::vector<std::uint8_t>(6, 1));
    for (std::int32_t v = 0; v < 6; ++v) {
        EXPECT_TRUE(around.can_go(v));
    }
    around.remove(0);
    EXPECT_TRUE(around.can_go(1));
    EXPECT_TRUE(around.can_go(5));
    EXPECT_FALSE(around.can_go(3));
    around.add(0);
    EXPECT_TRUE(around.can_go(3));
}

}  // namespace
}  // namespace vfplan
