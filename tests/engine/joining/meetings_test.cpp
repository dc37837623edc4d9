#include "engine/joining/meetings.h"

#include <gtest/gtest.h>

#include <random>

namespace vfplan {
namespace {

struct Piece {
    std::int32_t x;
    std::int32_t y;
    std::int32_t set;
};

TEST(Meetings, MissNoPlaceThatSeesSeveralSets) {
    std::size_t several = 0;
    std::size_t lonely = 0;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(seed);
        const auto below = [&](std::uint64_t n) { return static_cast<std::int32_t>(random() % n); };
        const auto reach = static_cast<std::int32_t>(1 + seed % 20);
        const Window window{-5, -7, 85, 63};
        std::vector<Piece> pieces;
        Meetings meetings(window, reach);
        for (int i = 0; i < 12; ++i) {
            const std::int32_t set = below(10) == 0 ? sees_several : below(3);
            pieces.push_back({below(90) - 5, below(70) - 7, set});
            meetings.add(pieces.back().x, pieces.back().y, set);
        }
        meetings.find();
        const auto near = [&](std::int32_t x, std::int32_t y, const Piece& p) {
            return (x - p.x) * (x - p.x) + (y - p.y) * (y - p.y) <= reach * reach;
        };
        std::vector<bool> meets(pieces.size(), false);
        for (std::int32_t y = window.y_begin; y < window.y_end; ++y) {
            for (std::int32_t x = window.x_begin; x < window.x_end; ++x) {
                std::int32_t sees = sees_nothing;
                for (const Piece& p : pieces) {
                    if (near(x, y, p)) sees = seen_together(sees, p.set);
                }
                if (sees != sees_several) continue;
                for (std::size_t i = 0; i < pieces.size(); ++i) {
                    if (near(x, y, pieces[i])) meets[i] = true;
                }
            }
        }
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            const bool found = meetings.near_several(pieces[i].x, pieces[i].y);
            ASSERT_TRUE(found || !meets[i]);
            several += meets[i] ? 1 : 0;
            lonely += found ? 0 : 1;
        }
    }
    EXPECT_GT(several, 100U);
    EXPECT_GT(lonely, 100U);
}

}  // namespace
}  // namespace vfplan
