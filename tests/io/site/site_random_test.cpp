// Hostile little sites by the hundred, against the drawing itself (drawing.h). VFPLAN_RANDOM_SITES
// says how many: 300 of each kind; `make random-sites` takes 10,000.
#include <gtest/gtest.h>

#include "kernels/free_cells.h"
#include "tests/io/site/drawing.h"
#include "tests/io/site/features.h"
#include "tests/io/site/random_sites.h"

namespace vfplan {
namespace {

using test::clear_m;
using test::Drawing;
using test::for_sites;
using test::most_wrong_m;
using test::Random;
using test::random_plan;
using test::random_town;
using test::shifted;
using test::worst_invented_m;
using test::worst_lost_m;

// --- outdoors ------------------------------------------------------------------------------------

TEST(RandomSites, OutdoorWallsAreThoseOfTheDrawing) {
    double faces_m = 0;
    double sites = 0;
    for_sites([&](std::uint64_t seed) {
        ++sites;
        Random random(seed);
        FeatureSet set = random_town(random);
        SiteOptions options;
        options.invalid = InvalidPolygons::repair;
        options.margin_m = 2;
        const Site site = build_site(set, options, "random").site;
        const Drawing drawn(shifted(std::move(set), -site.origin));
        EXPECT_LE(worst_invented_m(site, drawn, true), most_wrong_m);
        EXPECT_LE(worst_lost_m(site, drawn, [](const Vec2d&) { return true; }), most_wrong_m);
        int wrong_cells = 0;
        for (int i = 0; i < 300; ++i) {
            const Vec2d p(random.between(site.extent.min.x(), site.extent.max.x()),
                          random.between(site.extent.min.y(), site.extent.max.y()));
            if (drawn.clearance(p) < clear_m) continue;
            if (inside_odd(site.free_border, p) == drawn.solid(p)) ++wrong_cells;
        }
        EXPECT_EQ(wrong_cells, 0);
        for (const Wall& w : site.walls)
            faces_m += (w.free_side[0] + w.free_side[1]) * w.length_m();
    });
    EXPECT_GT(faces_m, 50 * sites);
}

// --- indoors -------------------------------------------------------------------------------------

TEST(RandomSites, IndoorFacesThatAreSeenAreThere) {
    double looked_from = 0;
    double faces_m = 0;
    double sites = 0;
    for_sites([&](std::uint64_t seed) {
        ++sites;
        Random random(seed + 1000000);
        FeatureSet set = random_plan(random);
        SiteOptions options;
        options.kind = SiteKind::indoor;
        const Site site = build_site(set, options, "random").site;
        const Drawing drawn(shifted(std::move(set), -site.origin));
        std::vector<Vec2d> eyes;
        int in_solids = 0;
        for (int i = 0; i < 300; ++i) {
            const Vec2d p(random.between(site.extent.min.x(), site.extent.max.x()),
                          random.between(site.extent.min.y(), site.extent.max.y()));
            if (drawn.clearance(p) < clear_m || !inside_odd(site.free_border, p)) continue;
            if (drawn.solid(p)) ++in_solids;
            if (eyes.size() < 25) eyes.push_back(p);
        }
        EXPECT_EQ(in_solids, 0);
        // Where a tripod has room, and where it can be seen from free ground, it may stand.
        int not_free = 0;
        for (int i = 0; i < 300; ++i) {
            const Vec2d p(random.between(site.extent.min.x(), site.extent.max.x()),
                          random.between(site.extent.min.y(), site.extent.max.y()));
            if (drawn.solid(p) || drawn.clearance(p) < 0.35 || inside_odd(site.free_border, p))
                continue;
            if (std::any_of(eyes.begin(), eyes.end(),
                            [&](const Vec2d& q) { return drawn.sees(p, q); })) {
                ++not_free;
            }
        }
        EXPECT_EQ(not_free, 0);
        EXPECT_LE(worst_invented_m(site, drawn, false), most_wrong_m);
        const auto seen = [&](const Vec2d& q) {
            return std::any_of(eyes.begin(), eyes.end(),
                               [&](const Vec2d& eye) { return drawn.sees(eye, q); });
        };
        EXPECT_LE(worst_lost_m(site, drawn, seen), most_wrong_m);
        looked_from += static_cast<double>(eyes.size());
        for (const Wall& w : site.walls)
            faces_m += (w.free_side[0] + w.free_side[1]) * w.length_m();
    });
    EXPECT_GT(looked_from, 20 * sites);
    EXPECT_GT(faces_m, 20 * sites);
}

}  // namespace
}  // namespace vfplan
