// Where the ground of a plan jumps as site.max_opening_m grows.
#include "io/site/openings.h"

#include <gtest/gtest.h>

#include "tests/io/site/features.h"

namespace vfplan {
namespace {

using test::add_line;
using test::add_polygon;

// Two rooms in a row, 4 x 6 m and 6 x 6 m; openings from outside into the first and from the first
// into the second.
FeatureSet two_rooms(double outer_m, double inner_m) {
    FeatureSet set;
    add_line(set, Role::wall,
             {{0, 3 + outer_m / 2}, {0, 6}, {10, 6}, {10, 0}, {0, 0}, {0, 3 - outer_m / 2}});
    add_line(set, Role::wall, {{4, 0}, {4, 3 - inner_m / 2}});
    add_line(set, Role::wall, {{4, 3 + inner_m / 2}, {4, 6}});
    return set;
}

SiteOptions options(double max_opening_m) {
    SiteOptions out;
    out.kind = SiteKind::indoor;
    out.max_opening_m = max_opening_m;
    out.opening_steps_up_to_m = 6;
    return out;
}

TEST(Openings, RoomsComeInByTheirOpenings) {
    const auto steps = build_site(two_rooms(1.5, 0.8), options(2), "plan").opening_steps;
    ASSERT_EQ(steps.size(), 2U);
    EXPECT_NEAR(steps[0].opening_m, 0.8, 0.002);
    EXPECT_NEAR(steps[0].inside_m2, 36, 1e-6);
    EXPECT_NEAR(steps[1].opening_m, 1.5, 0.002);
    EXPECT_NEAR(steps[1].inside_m2, 60, 1e-6);
    // Through the first room only what comes through its own opening.
    const auto narrow = build_site(two_rooms(0.9, 1.4), options(2), "plan").opening_steps;
    ASSERT_EQ(narrow.size(), 1U);
    EXPECT_NEAR(narrow[0].opening_m, 0.9, 0.002);
    EXPECT_NEAR(narrow[0].inside_m2, 60, 1e-6);
}

// The curve is what the reader finds for each width.
TEST(Openings, TheGroundAgreesOnBothSidesOfAStep) {
    const FeatureSet set = two_rooms(2.6, 1.7);
    for (const OpeningStep& s : build_site(set, options(2), "plan").opening_steps) {
        const Site site = build_site(set, options(s.opening_m + 0.01), "plan").site;
        EXPECT_NEAR(site.area_m2, s.inside_m2, 0.1) << s.opening_m;
    }
    EXPECT_NEAR(build_site(set, options(1.72), "plan").site.area_m2, 36, 0.1);
}

TEST(Openings, RoomsThatAreDrawnDependOnNoWidth) {
    FeatureSet set = two_rooms(1.5, 0.8);
    add_polygon(set, Role::room, test::box_ring(0, 0, 4, 6));
    EXPECT_TRUE(build_site(set, options(2), "plan").opening_steps.empty());
}

}  // namespace
}  // namespace vfplan
