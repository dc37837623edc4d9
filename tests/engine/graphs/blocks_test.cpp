#include "engine/graphs/blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace vfplan {
namespace {

using Links = std::vector<std::vector<std::uint8_t>>;

// Whether a path leads from a to b that avoids a node.
bool path(const Links& links, int a, int b, int without) {
    std::vector<int> queue = {a};
    std::vector<std::uint8_t> seen(links.size(), 0);
    seen[idx(a)] = 1;
    for (std::size_t i = 0; i < queue.size(); ++i) {
        for (int n = 0; n < static_cast<int>(links.size()); ++n) {
            if (links[idx(queue[i])][idx(n)] == 0 || seen[idx(n)] != 0 || n == without) continue;
            seen[idx(n)] = 1;
            queue.push_back(n);
        }
    }
    return seen[idx(b)] != 0;
}

// Two nodes share a block iff they are linked, or no third node's loss parts them.
TEST(NodeBlocks, AreWhatNoSingleNodeParts) {
    std::mt19937_64 random(3);
    for (int round = 0; round < 400; ++round) {
        const int n = 1 + static_cast<int>(random() % 14);
        const auto sparse = 2 + random() % 5;
        Links links(idx(n), std::vector<std::uint8_t>(idx(n), 0));
        for (int a = 0; a < n; ++a) {
            for (int b = 0; b < a; ++b) {
                links[idx(a)][idx(b)] = links[idx(b)][idx(a)] = random() % sparse == 0 ? 1 : 0;
            }
        }
        Sparse near;
        int parts = 0;
        for (int a = 0; a < n; ++a) {
            bool first = true;
            for (int b = 0; b < n; ++b) {
                if (links[idx(a)][idx(b)] != 0) near.to.push_back(b);
                if (b < a && path(links, a, b, -1)) first = false;
            }
            parts += first ? 1 : 0;
            near.end_list();
        }
        std::int32_t counted = 0;
        const Sparse blocks = find_blocks(near, &counted);
        EXPECT_EQ(counted, parts) << "round " << round;
        std::set<std::pair<int, int>> together;
        for (std::int32_t k = 0; k < blocks.size(); ++k) {
            for (const std::int32_t a : blocks.of(k)) {
                for (const std::int32_t b : blocks.of(k)) {
                    if (a >= b) continue;
                    EXPECT_TRUE(together.emplace(a, b).second) << "round " << round;
                }
            }
        }
        for (int a = 0; a < n; ++a) {
            for (int b = a + 1; b < n; ++b) {
                bool want = path(links, a, b, -1);
                for (int c = 0; c < n && want && links[idx(a)][idx(b)] == 0; ++c) {
                    if (c != a && c != b) want = path(links, a, b, c);
                }
                EXPECT_EQ(together.count({a, b}) > 0, want) << "round " << round;
            }
        }
    }
}

}  // namespace
}  // namespace vfplan
