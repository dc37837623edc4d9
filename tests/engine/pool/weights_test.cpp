// What pieces weigh, against closed forms and brute force.
#include "engine/pool/weights.h"

#include <gtest/gtest.h>

#include <bit>
#include <random>

#include "kernels/certificate.h"

namespace vfplan {
namespace {

Sparse rows_of(const std::vector<std::vector<std::int32_t>>& lists) {
    Sparse out;
    for (const auto& list : lists) {
        out.to.insert(out.to.end(), list.begin(), list.end());
        out.end_list();
    }
    return out;
}

double weight_of(const std::vector<std::int64_t>& weight, const std::vector<std::int32_t>& row) {
    double sum = 0;
    for (const std::int32_t p : row) sum += static_cast<double>(weight[idx(p)]);
    return sum / proof_scale;
}

TEST(PieceWeights, OfRowsThatShareNothingAreOneEachAtLeast) {
    const std::vector<std::vector<std::int32_t>> lists = {{0, 1, 2}, {3}, {4, 5}};
    const auto weight = weigh_pieces(rows_of(lists), 7);
    // No cover does without any of them, so what they weigh beyond 1 means nothing.
    for (const auto& row : lists) EXPECT_GE(weight_of(weight, row), 0.98);
    EXPECT_EQ(weight[0], weight[1]);  // the same candidates cover both
    EXPECT_EQ(weight[6], 0);          // nobody does
}

// Three pieces, each pair of which one candidate covers: two stations cover all, and the weights
// say 1.5. A point that covers all three would be worth more than 1.
TEST(PieceWeights, PriceAPointThatWouldSaveAStation) {
    const auto weight = weigh_pieces(rows_of({{0, 1}, {1, 2}, {0, 2}}), 3);
    EXPECT_GT(weight_of(weight, {0, 1, 2}), 1.4);
    EXPECT_LT(weight_of(weight, {0, 1}), 1.1);
}

// sum of weights - sum of what rows weigh beyond 1 bounds any cover from below.
TEST(PieceWeights, BoundEveryCover) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        const auto pieces = static_cast<std::int32_t>(3 + random() % 20);
        const std::size_t candidates = 2 + random() % 9;
        std::vector<std::vector<std::int32_t>> lists(candidates);
        for (auto& list : lists) {
            for (std::int32_t p = 0; p < pieces; ++p) {
                if (random() % 3 == 0) list.push_back(p);
            }
        }
        const auto weight = weigh_pieces(rows_of(lists), pieces);
        double bound = 0;
        for (const std::int64_t w : weight) {
            EXPECT_GE(w, 0);
            bound += static_cast<double>(w) / proof_scale;
        }
        for (const auto& row : lists) bound -= std::max(0.0, weight_of(weight, row) - 1);
        std::uint32_t all = 0;
        std::vector<std::uint32_t> bits;
        for (const auto& row : lists) {
            bits.push_back(0);
            for (const std::int32_t p : row) bits.back() |= 1U << static_cast<unsigned>(p);
            all |= bits.back();
        }
        int best = static_cast<int>(candidates);
        for (std::uint32_t choice = 0; choice < 1U << candidates; ++choice) {
            std::uint32_t covered = 0;
            for (std::size_t c = 0; c < candidates; ++c) {
                if ((choice >> c & 1U) != 0) covered |= bits[c];
            }
            if (covered == all) best = std::min(best, std::popcount(choice));
        }
        EXPECT_LE(bound, best + 1e-6);
        EXPECT_GE(bound, 0.5 * best);  // and it is worth something
    }
}

}  // namespace
}  // namespace vfplan
