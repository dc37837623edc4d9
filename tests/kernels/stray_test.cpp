// Which boxes lie so far from the others that what covers them is mostly empty.
#include "kernels/stray.h"

#include <gtest/gtest.h>

namespace vfplan {
namespace {

using Numbers = std::vector<std::size_t>;

Box box(double x, double y, double width, double height) {
    return {{x, y}, {x + width, y + height}};
}

// Houses of 10 m on a lattice of 30 m.
std::vector<Box> town(int columns, int rows) {
    std::vector<Box> out;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) out.push_back(box(30 * x, 30 * y, 10, 10));
    }
    return out;
}

Numbers strays(const std::vector<Box>& boxes, double margin = 0) {
    return find_strays(boxes, margin).boxes;
}

TEST(Strays, NoneInATown) {
    EXPECT_EQ(strays({}), Numbers());
    EXPECT_EQ(strays({box(0, 0, 10, 10)}), Numbers());
    EXPECT_EQ(strays({box(0, 0, 10, 10), box(15, 0, 10, 10)}), Numbers());
    EXPECT_EQ(strays(town(20, 10)), Numbers());
    // A farm 200 m off, not even as far as the town is wide.
    auto boxes = town(20, 10);
    boxes.push_back(box(800, 100, 10, 10));
    EXPECT_EQ(strays(boxes), Numbers());
}

TEST(Strays, OneFarOff) {
    for (const double far : {5e3, 5e4, 1e6}) {
        for (const Vec2d& to : {Vec2d(1, 1), Vec2d(-1, 1), Vec2d(-1, -1), Vec2d(1, -1)}) {
            auto boxes = town(5, 5);
            boxes.insert(boxes.begin() + 7, box(far * to.x(), far * to.y(), 0.1, 0));
            const Strays s = find_strays(boxes, 10);
            EXPECT_EQ(s.boxes, Numbers{7});
            EXPECT_GT(s.times, 10);
            EXPECT_EQ(s.rest.max, Vec2d(130, 130));
            EXPECT_EQ(s.rest.min, Vec2d(0, 0));
        }
    }
}

TEST(Strays, OnOneAxisOnly) {
    auto boxes = town(5, 5);
    boxes.push_back(box(5000, 60, 10, 10));
    EXPECT_EQ(strays(boxes), Numbers{25});
}

TEST(Strays, AFewTogetherOrOnAllSides) {
    auto boxes = town(10, 10);
    for (const Box& b : {box(9000, 9000, 10, 10), box(9020, 9000, 10, 10), box(-8000, 50, 5, 5),
                         box(50, -7000, 5, 5), box(9000, 100, 5, 5)}) {
        boxes.push_back(b);
    }
    EXPECT_EQ(strays(boxes), (Numbers{100, 101, 102, 103, 104}));
}

TEST(Strays, OneThatHangsOnToTheOthers) {
    auto boxes = town(3, 3);
    boxes.push_back(box(20, 20, 0, 5e5));  // a window that ends nowhere
    EXPECT_EQ(strays(boxes), Numbers{9});
}

TEST(Strays, OfTwoAloneTheSecond) {
    EXPECT_EQ(strays({box(0, 0, 20, 20), box(5e4, 0, 3, 3)}), Numbers{1});
    EXPECT_EQ(strays({box(5e4, 0, 3, 3), box(0, 0, 20, 20)}), Numbers{1});
    EXPECT_EQ(strays({box(0, 0, 20, 20), {}, box(0, 1e6, 30, 30)}), Numbers{2});
}

TEST(Strays, TwoTownsAreNone) {
    auto boxes = town(10, 10);
    for (Box b : town(10, 10)) {
        b.min.x() += 2e4;
        b.max.x() += 2e4;
        boxes.push_back(b);
    }
    EXPECT_EQ(strays(boxes), Numbers());
}

// What lies around is much more of a small site than of a large one.
TEST(Strays, TheMarginCounts) {
    const std::vector<Box> boxes = {box(0, 0, 10, 10), box(120, 0, 10, 10)};
    EXPECT_EQ(strays(boxes), Numbers{1});
    EXPECT_EQ(strays(boxes, 20), Numbers());
}

}  // namespace
}  // namespace vfplan
