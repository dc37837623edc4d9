// Sites that lost walls or faces once, with the right lengths; and streets of Monaco against their
// drawing.
#include <gtest/gtest.h>

#include "io/formats/read_features.h"
#include "tests/data.h"
#include "tests/io/site/drawing.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

using test::add_line;
using test::add_polygon;
using test::box_ring;
using test::indoor;

double faces_m(const Site& site) {
    double sum = 0;
    for (const Wall& w : site.walls) {
        if (w.scanned) sum += (w.free_side[left] + w.free_side[right]) * w.length_m();
    }
    return sum;
}

double indoor_faces_m(const FeatureSet& set) {
    return faces_m(build_site(set, indoor(), "case").site);
}

// A room of 10 x 6 m.
FeatureSet room() {
    FeatureSet set;
    add_polygon(set, Role::outline, box_ring(0, 0, 10, 6));
    return set;
}

TEST(LostFace, CupboardBeforeAWall) {
    FeatureSet set = room();
    add_polygon(set, Role::obstacle, box_ring(4.6, 5.45, 5.8, 5.95));
    EXPECT_NEAR(indoor_faces_m(set), 32,
                1e-9);  // all of the room's wall; the cupboard needs no scan
    FeatureSet as_wall = room();
    add_polygon(as_wall, Role::wall, box_ring(4.6, 5.45, 5.8, 5.95));
    EXPECT_NEAR(indoor_faces_m(as_wall), 32 + 3.4, 1e-9);
    FeatureSet touching = room();
    add_polygon(touching, Role::obstacle, box_ring(4.6, 5.45, 5.8, 6));
    EXPECT_NEAR(indoor_faces_m(touching), 32 - 1.2, 1e-9);
}

TEST(LostFace, BoardBeforeAWall) {
    FeatureSet set = room();
    add_line(set, Role::wall, {{4.5, 5.95}, {5.5, 5.95}});
    EXPECT_NEAR(indoor_faces_m(set), 32 + 2, 1e-9);
}

TEST(LostFace, Pilasters) {
    for (const double depth : {0.05, 0.1, 0.14, 0.2}) {
        Ring ring = {{0, 0}};
        for (const double x : {1.5, 3.5, 5.5, 7.5}) {
            for (const Vec2d& p :
                 {Vec2d(x, 0), Vec2d(x, depth), Vec2d(x + 0.5, depth), Vec2d(x + 0.5, 0)}) {
                ring.push_back(p);
            }
        }
        for (const Vec2d& p : {Vec2d(10, 0), Vec2d(10, 6), Vec2d(0, 6)}) ring.push_back(p);
        FeatureSet set;
        add_polygon(set, Role::outline, ring);
        EXPECT_NEAR(indoor_faces_m(set), 32 + 8 * depth, 1e-9) << depth;
    }
}

// Every side against the drawing, and the length of all sides.
void expect_as_drawn(FeatureSet set, double length_m) {
    const Site site = build_site(set, {}, "case").site;
    for (Feature& f : set.features) each_point(f, [&](Vec2d& v) { v -= site.origin; });
    const test::Drawing drawn(set);
    EXPECT_LE(test::worst_invented_m(site, drawn, true), 0.005);
    EXPECT_LE(test::worst_lost_m(site, drawn, [](const Vec2d&) { return true; }), 0.005);
    EXPECT_NEAR(faces_m(site), length_m, 0.02);
}

TEST(MissingWall, ThreeBuildings) {
    FeatureSet set;
    add_polygon(set, Role::building, box_ring(999, 7297.9, 1005.6, 7304.4),
                {box_ring(999.8, 7298.6, 1004.8, 7303.6)});
    set.features.back().polygons.push_back({box_ring(1000.9, 7299.7, 1003.7, 7302.5), {}});
    add_polygon(set, Role::building,
                {{1007.5, 7305.5}, {1006.2, 7306.2}, {1003.7, 7301.7}, {1005.1, 7301}});
    add_polygon(set, Role::building, box_ring(1005.2, 7305.2, 1011.3, 7311.3),
                {box_ring(1006.3, 7306.3, 1010.2, 7310.2)});
    // The length of the union, and of the fence outside it twice, by GEOS on the drawing.
    expect_as_drawn(std::move(set), 98.3635);
}

TEST(MissingWall, FenceThroughABuilding) {
    FeatureSet set;
    add_polygon(set, Role::building,
                {{8.27982695322462, 8.391168694452583},
                 {3.6428150839152087, 7.332297432040454},
                 {3.9686884426668216, 5.905231946307387},
                 {8.605700311976232, 6.964103208719516}});
    add_line(set, Role::wall,
             {{3.62, 0.48}, {0.83, 11.1}, {2.37, 6.31}, {4.25, 4.28}, {10.86, 10.6}});
    expect_as_drawn(std::move(set), 63.4269);
}

TEST(MissingWall, StreetsOfMonaco) {
    VFPLAN_NEED_DATA("town_monaco/monaco_full.geojson");
    FeatureSet set = read_features(test::data_dir() / "town_monaco/monaco_full.geojson", {});
    const Box keep{{700, 1250}, {840, 1390}};
    std::erase_if(set.features, [&](Feature& f) {
        Box box;
        each_point(f, [&](const Vec2d& v) { box.add(v); });
        return !keep.contains((box.min + box.max) / 2);
    });
    ASSERT_GT(set.features.size(), 20U);
    const Site site = build_site(set, {}, "Monaco").site;
    for (Feature& f : set.features) each_point(f, [&](Vec2d& v) { v -= site.origin; });
    const test::Drawing drawn(set);
    EXPECT_LE(test::worst_invented_m(site, drawn, true), 0.005);
    EXPECT_LE(test::worst_lost_m(site, drawn, [](const Vec2d&) { return true; }), 0.005);
}

}  // namespace
}  // namespace vfplan
