#include "engine/plan/order.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/engine/plan/hand_made.h"

namespace vfplan {
namespace {

using test::hand_made;
using test::HandMade;

Chosen ordered(const HandMade& h, const Chosen& network, const std::vector<std::uint8_t>& covered) {
    Workspace work(h.graph);
    const Chosen out = in_order(h.input(), network, covered, work);
    EXPECT_EQ(std::count(work.mark.begin(), work.mark.end(), 0), h.graph.size());
    return out;
}

TEST(Order, MostLengthFirstThenAlwaysLinkedWithTheMostNewLength) {
    // A path 0 - 1 - 2 - 3 with a leaf 4 at 1.
    const HandMade h = hand_made({5, 1, 2, 4, 3}, {{1}, {0, 1}, {2}, {3}, {4}},
                                 {{0, 1, 0.5}, {1, 2, 0.5}, {2, 3, 0.5}, {1, 4, 0.9}});
    EXPECT_EQ(ordered(h, {0, 1, 2, 3, 4}, {0, 0, 0, 0, 0}), (Chosen{1, 4, 2, 3, 0}));
    // What is covered before counts for nobody.
    EXPECT_EQ(ordered(h, {0, 1, 2, 3, 4}, {1, 1, 0, 0, 1}), (Chosen{3, 2, 1, 4, 0}));
}

TEST(Order, EachStationIsThereOnceAndLinkedToOneBeforeIt) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
        SCOPED_TRACE(seed);
        const HandMade h = test::random_hand_made(seed, 30, 60);
        std::vector<std::uint8_t> wanted = h.wanted();
        const Chosen network = test::greedy_alone(h, h.everyone(), {}, wanted);
        const Chosen out = ordered(h, network, std::vector<std::uint8_t>(h.length_m.size(), 0));
        EXPECT_TRUE(std::is_permutation(out.begin(), out.end(), network.begin(), network.end()));
        for (std::size_t i = 1; i <= out.size(); ++i) {
            EXPECT_TRUE(h.connected(Chosen(out.begin(), out.begin() + static_cast<long>(i))));
        }
    }
}

}  // namespace
}  // namespace vfplan
