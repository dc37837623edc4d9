#include "engine/check/survival_check.h"

#include <gtest/gtest.h>

namespace vfplan {
namespace {

// A network over four candidates, of which each covers piece 0, and candidate 3 alone piece 1.
struct Four {
    std::vector<std::int32_t> members = {0, 1, 2, 3};
    std::vector<std::uint8_t> chosen;
    std::vector<std::vector<std::int32_t>> near;
    OverlapRows rows;
    std::vector<std::int32_t> owner = {0, 0};

    Four(std::vector<std::uint8_t> stations, std::vector<std::vector<std::int32_t>> links)
        : chosen(std::move(stations)), near(std::move(links)) {
        for (const std::int32_t c : members) {
            rows.piece.push_back(0);
            if (c == 3) rows.piece.push_back(1);
            rows.begin.push_back(static_cast<std::int64_t>(rows.piece.size()));
        }
    }
    Survival check() const { return check_survival({members, chosen, near, rows, owner, 0}); }
};

const std::vector<std::vector<std::int32_t>> ring = {{1, 3}, {0, 2}, {1, 3}, {0, 2}};
const std::vector<std::vector<std::int32_t>> path = {{1}, {0, 2}, {1, 3}, {2}};

TEST(SurvivalCheck, AWholeRingStandsEveryLoss) {
    const Survival s = Four({1, 1, 1, 1}, ring).check();
    EXPECT_EQ(s.wrong, "");
    EXPECT_EQ(s.parting, 0);
    EXPECT_EQ(s.pieces_alone, 1);
}

TEST(SurvivalCheck, APartOfARingNeedNotFallApart) {
    const Survival s = Four({0, 1, 1, 1}, ring).check();
    EXPECT_EQ(s.parting, 1);
    EXPECT_NE(s.wrong.find("candidate 2"), std::string::npos) << s.wrong;
}

TEST(SurvivalCheck, APathHasNoOtherWay) {
    const Survival s = Four({1, 1, 1, 1}, path).check();
    EXPECT_EQ(s.parting, 2);
    EXPECT_EQ(s.wrong, "");
}

TEST(SurvivalCheck, APieceThatTwoCouldCoverNeedsTwo) {
    const Survival s = Four({0, 0, 0, 1}, ring).check();
    EXPECT_NE(s.wrong.find("piece 0"), std::string::npos) << s.wrong;
    EXPECT_EQ(s.pieces_alone, 1);
}

}  // namespace
}  // namespace vfplan
