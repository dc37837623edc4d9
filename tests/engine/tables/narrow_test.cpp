#include "engine/tables/narrow.h"

#include <gtest/gtest.h>

#include "engine/tables/site.h"
#include "tests/engine/tables/ground.h"

namespace vfplan {
namespace {

using test::box_ring;
using test::ring_of;

struct Floor {
    GroundOptions options;
    Site site;

    explicit Floor(const std::vector<Ring>& rings, double cell_m = 0.02) {
        options.cell_m = cell_m;
        options.clearance_m = 0.4;
        options.range_max_m = 30;
        options.site.min_room_m2 = 1;
        site.free_border = border_of(rings);
        for (const Ring& r : rings) test::add_ring(site.walls, r);
        site.extent = test::bounds_of(site.walls);
    }
    std::vector<NarrowPlace> places(int threads = 2) const {
        return narrow_places(options, site, layout_of(options, site), Threads(threads));
    }
};

// A room of 5 x 5 m, a corridor of 0.7 x 4 m from it and another of 0.5 x 2.2 m.
Ring with_corridors() {
    return ring_of({{0, 0},
                    {5, 0},
                    {5, 1},
                    {9, 1},
                    {9, 1.7},
                    {5, 1.7},
                    {5, 5},
                    {3, 5},
                    {3, 7.2},
                    {2.5, 7.2},
                    {2.5, 5},
                    {0, 5}});
}

TEST(Narrow, CorridorsAreToldByTheirSize) {
    const Floor floor({with_corridors()});
    const auto places = floor.places();
    ASSERT_EQ(places.size(), 2u);
    // All but where the corridor's mouth lies within the clearance of a station before it.
    EXPECT_NEAR(places[0].area_m2, 0.7 * 4, 0.15);
    EXPECT_NEAR(places[1].area_m2, 0.5 * 2.2, 0.1);
    EXPECT_NEAR(area_m2(places), places[0].area_m2 + places[1].area_m2, 1e-9);
    EXPECT_NEAR(places[0].at.x(), 7, 0.2);
    EXPECT_NEAR(places[1].at.x(), 2.75, 0.02);
    EXPECT_NEAR(places[1].at.y(), 6.2, 0.2);
    const std::string text = narrow_text(places, floor.options, floor.site);
    EXPECT_NE(text.find("in 2 places"), std::string::npos) << text;
    EXPECT_NE(text.find("site.clearance_m"), std::string::npos) << text;
}

TEST(Narrow, RoomsCornersAndDoorwaysAreNot) {
    const Ring rooms = ring_of({{0, 0},
                                {4, 0},
                                {4, 1.7},
                                {4.2, 1.7},
                                {4.2, 0},
                                {8, 0},
                                {8, 4},
                                {4.2, 4},
                                {4.2, 2.3},
                                {4, 2.3},
                                {4, 4},
                                {0, 4}});
    Floor floor({rooms});
    floor.options.site.min_room_m2 = 0.04;
    EXPECT_TRUE(floor.places().empty());
}

TEST(Narrow, WithoutAClearanceNothingIs) {
    Floor floor({with_corridors()});
    floor.options.clearance_m = 0;
    EXPECT_TRUE(floor.places().empty());
}

TEST(Narrow, AsManyAsTheSiteHasInAnyNumberOfThreads) {
    // Closets of 0.6 x 2 m apart from each other, over several bands of rows.
    std::vector<Ring> rings;
    for (int k = 0; k < 12; ++k) {
        rings.push_back(box_ring(k, 1.7 * k, k + 0.6, 1.7 * k + 2 + 0.01 * k));
    }
    rings.push_back(box_ring(20, 0, 30, 10));
    const Floor floor(rings);
    const auto one = floor.places(1);
    const auto two = floor.places(2);
    ASSERT_EQ(one.size(), 12u);
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_NEAR(one[i].area_m2, 0.6 * (2 + 0.01 * static_cast<double>(11 - i)), 0.03);
        EXPECT_EQ(one[i].at, two[i].at);
        EXPECT_EQ(one[i].area_m2, two[i].area_m2);
    }
}

TEST(Narrow, CoarseCellsCallNothingNarrowThatIsNot) {
    Floor floor({box_ring(0, 0, 40, 30)}, 2);
    EXPECT_TRUE(floor.places().empty());
}

}  // namespace
}  // namespace vfplan
