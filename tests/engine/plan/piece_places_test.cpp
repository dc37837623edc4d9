#include "engine/plan/piece_places.h"

#include <gtest/gtest.h>

#include <random>

namespace vfplan {
namespace {

TEST(PiecePlaces, LieWherePiecesWereCut) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> number(-20, 20);
    std::vector<Wall> walls(60);
    for (std::size_t w = 0; w < walls.size(); ++w) {
        walls[w].a = {number(random), number(random)};
        walls[w].b = {number(random), number(random)};
        walls[w].scanned = w % 7 != 3;
        walls[w].free_side[left] = w % 3 != 0;
        walls[w].free_side[right] = w % 5 != 0;
    }
    const Pieces pieces = cut_into_pieces(walls, 1);
    const PiecePlaces places(walls, pieces);
    std::vector<std::int32_t> some;
    for (std::int32_t p = 0; p < pieces.size(); ++p) {
        if (p < 50 || random() % 3 == 0) some.push_back(p);
    }
    std::size_t called = 0;
    places.each(some, [&](std::int32_t p, const PiecePlaces::Place& place) {
        EXPECT_EQ(p, some[called++]);
        const Pieces::Place piece = pieces.place(p);
        const Wall& wall = walls[idx(piece.wall)];
        EXPECT_EQ(place.middle, wall.at((piece.s0_m + piece.s1_m) / 2));
        EXPECT_EQ(place.along, (wall.b - wall.a).normalized());
    });
    EXPECT_EQ(called, some.size());
}

}  // namespace
}  // namespace vfplan
