#include "engine/graphs/shortcuts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace vfplan {
namespace {

// Sum of the ways between `ends`, over nodes of `chosen`, by Floyd and Warshall's algorithm;
// infinite where they are apart.
double sum_of_ways(const Graph& graph, std::vector<std::int32_t> chosen,
                   const std::vector<std::int32_t>& ends) {
    std::sort(chosen.begin(), chosen.end());
    const Graph part = induced(graph, chosen);
    const auto n = static_cast<std::size_t>(part.size());
    std::vector<std::vector<double>> way(
        n, std::vector<double>(n, std::numeric_limits<double>::infinity()));
    for (std::size_t v = 0; v < n; ++v) {
        way[v][v] = 0;
        part.each(static_cast<std::int32_t>(v),
                  [&](std::int32_t to, double overlap) { way[v][idx(to)] = 1 - overlap; });
    }
    for (std::size_t k = 0; k < n; ++k) {
        for (std::size_t u = 0; u < n; ++u) {
            for (std::size_t v = 0; v < n; ++v) {
                way[u][v] = std::min(way[u][v], way[u][k] + way[k][v]);
            }
        }
    }
    const auto is_end = [&](std::size_t v) {
        return std::find(ends.begin(), ends.end(), chosen[v]) != ends.end();
    };
    double sum = 0;
    for (std::size_t u = 0; u < n; ++u) {
        for (std::size_t v = 0; v < n; ++v) {
            if (is_end(u) && is_end(v)) sum += way[u][v];
        }
    }
    return sum;
}

struct Case {
    Graph graph;
    std::vector<std::int32_t> chosen;
};

// A ring of chosen nodes, and nodes beside them that are joined at random.
Case random_case(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto below = [&](int n) { return static_cast<std::int32_t>(random() % idx(n)); };
    const std::int32_t ring = 4 + below(20);
    const std::int32_t all = ring + below(25);
    std::uniform_real_distribution<double> overlap(0.3, 0.9);
    std::vector<OverlapPair> pairs;
    for (std::int32_t v = 0; v + 1 < ring; ++v) pairs.push_back({v, v + 1, overlap(random)});
    for (std::int32_t c = ring; c < all; ++c) {
        const std::int32_t links = below(5);
        for (std::int32_t k = 0; k < links; ++k) pairs.push_back({below(c), c, overlap(random)});
    }
    std::sort(pairs.begin(), pairs.end(), [](const OverlapPair& a, const OverlapPair& b) {
        return std::pair(a.from, a.to) < std::pair(b.from, b.to);
    });
    pairs.erase(std::unique(pairs.begin(), pairs.end(),
                            [](const OverlapPair& a, const OverlapPair& b) {
                                return a.from == b.from && a.to == b.to;
                            }),
                pairs.end());
    Case out{make_graph(all, pairs), {}};
    for (std::int32_t v = 0; v < ring; ++v) out.chosen.push_back(v);
    return out;
}

TEST(Shortcuts, EachIsTheBestThereIs) {
    int taken = 0;
    for (std::uint64_t seed = 1; seed <= 400; ++seed) {
        const Case c = random_case(seed);
        const auto added = shortcuts(c.graph, c.chosen, 3);
        std::vector<std::int32_t> now = c.chosen;
        for (std::size_t i = 0; i <= added.size() && i < 3; ++i) {
            const double before = sum_of_ways(c.graph, now, now);
            const auto with = [&](std::int32_t v) {
                std::vector<std::int32_t> more = now;
                more.push_back(v);
                return sum_of_ways(c.graph, more, now);
            };
            double best = before;
            for (std::int32_t v = 0; v < c.graph.size(); ++v) {
                if (std::find(now.begin(), now.end(), v) == now.end())
                    best = std::min(best, with(v));
            }
            if (i == added.size()) {
                EXPECT_NEAR(best, before, 1e-6) << "seed " << seed;
                continue;
            }
            EXPECT_LT(with(added[i]), before) << "seed " << seed;
            EXPECT_NEAR(with(added[i]), best, 1e-6) << "seed " << seed;
            now.push_back(added[i]);
            ++taken;
        }
    }
    EXPECT_GT(taken, 300);
}

TEST(Shortcuts, AreNoMoreThanAskedFor) {
    for (std::uint64_t seed = 1; seed <= 50; ++seed) {
        const Case c = random_case(seed);
        const auto many = shortcuts(c.graph, c.chosen, 100);
        for (const std::int64_t most : {0, 1, 2}) {
            const auto few = shortcuts(c.graph, c.chosen, most);
            const auto count = std::min(many.size(), static_cast<std::size_t>(most));
            ASSERT_EQ(few, std::vector<std::int32_t>(
                               many.begin(), many.begin() + static_cast<std::ptrdiff_t>(count)));
        }
    }
}

}  // namespace
}  // namespace vfplan
