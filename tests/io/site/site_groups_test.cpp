// Sites are cleaned group by group: groups are those of the definition, and what one group gives, a
// hundred of them give a hundred times, in whatever order and portions they are worked on.
#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "io/site/groups.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

using test::add_line;
using test::add_polygon;
using test::box_ring;

bool near(const Box& a, const Box& b, double near_m) {
    for (const int k : {0, 1}) {
        if (a.min[k] - b.max[k] > near_m || b.min[k] - a.max[k] > near_m) return false;
    }
    return true;
}

TEST(Groups, AreTheClosureOfBeingNear) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> place(0, 100);
    std::uniform_real_distribution<double> size(0.1, 6);
    std::size_t groups_in_all = 0;
    for (int round = 0; round < 40; ++round) {
        std::vector<Box> boxes;
        for (int i = 0; i < 10 + 4 * round; ++i) {
            const Vec2d at(place(random), place(random));
            boxes.push_back({at, at + Vec2d(size(random), i % 9 == 0 ? 40.0 : size(random))});
        }
        std::vector<std::size_t> group(boxes.size());
        std::iota(group.begin(), group.end(), 0U);
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t a = 0; a < boxes.size(); ++a) {
                for (std::size_t b = 0; b < boxes.size(); ++b) {
                    if (group[a] == group[b] || !near(boxes[a], boxes[b], 0.5)) continue;
                    group[a] = group[b] = std::min(group[a], group[b]);
                    changed = true;
                }
            }
        }
        std::vector<int> met(boxes.size(), 0);
        const auto got = neighbour_groups(boxes, 0.5);
        for (const auto& members : got) {
            ASSERT_FALSE(members.empty());
            EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
            for (const std::size_t m : members) {
                ++met[m];
                EXPECT_EQ(group[m], group[members.front()]);
            }
        }
        EXPECT_EQ(std::count(met.begin(), met.end(), 1), static_cast<std::ptrdiff_t>(boxes.size()));
        std::sort(group.begin(), group.end());
        const auto different = std::unique(group.begin(), group.end()) - group.begin();
        EXPECT_EQ(static_cast<std::ptrdiff_t>(got.size()), different);
        groups_in_all += got.size();
    }
    EXPECT_GT(groups_in_all, 100U);
}

// Two houses wall to wall, one upon another, one inside, a courtyard, and a fence between two.
void add_group(FeatureSet& set, double x, double y) {
    const auto house = [&](double x0, double y0, double x1, double y1) {
        return box_ring(x + x0, y + y0, x + x1, y + y1);
    };
    add_polygon(set, Role::building, house(0, 0, 10, 8));
    add_polygon(set, Role::building, house(10, 0, 20, 8));
    add_polygon(set, Role::building, house(15, 4, 25, 12));
    add_polygon(set, Role::building, house(2, 2, 4, 4));
    add_polygon(set, Role::building, house(0, 20, 20, 40), {house(5, 25, 15, 35)});
    add_line(set, Role::wall, {{x + 3, y + 8}, {x + 3, y + 20}});
}

std::vector<std::int64_t> counts_of(const Site& site) {
    const CleaningCounts& c = site.counts;
    return {site.buildings, static_cast<std::int64_t>(site.walls.size()),
            c.features,     c.edges_in,
            c.zero_length,  c.duplicates,
            c.split,        c.merged,
            c.inside_solids};
}

TEST(Groups, OfOneKindAddUp) {
    FeatureSet single;
    add_group(single, 0, 0);
    const Site one = build_site(single, {}, "one").site;
    EXPECT_EQ(one.counts.features, 6);
    EXPECT_EQ(one.counts.edges_in, 4 * 4 + 8 + 1);
    EXPECT_EQ(one.buildings, 5);
    // The outline of three houses in one, the courtyard's house and the fence; the rest is buried.
    EXPECT_NEAR(test::total_length(one), 2 * (25 + 12) + 80 + 40 + 12, 1e-9);

    FeatureSet many;
    std::vector<std::pair<double, double>> places;
    for (int i = 0; i < 100; ++i) places.emplace_back(60.0 * (i % 10), 70.0 * (i / 10));
    for (const auto& [x, y] : places) add_group(many, x, y);
    const Site all = build_site(many, {}, "many").site;
    std::vector<std::int64_t> want = counts_of(one);
    for (std::int64_t& n : want) n *= 100;
    EXPECT_EQ(counts_of(all), want);
    EXPECT_NEAR(all.area_m2, 100 * one.area_m2, 1e-6);
    EXPECT_NEAR(test::total_length(all), 100 * test::total_length(one), 1e-6);

    // In another order, one by one and from behind.
    FeatureSet turned;
    std::mt19937_64 random(2);
    std::shuffle(places.begin(), places.end(), random);
    for (const auto& [x, y] : places) add_group(turned, x, y);
    SiteOptions backwards;
    backwards.for_each = [](std::int64_t n, const SiteOptions::Body& body) {
        for (std::int64_t i = n; i-- > 0;) body(i, i + 1);
    };
    const Site again = build_site(turned, backwards, "turned").site;
    EXPECT_EQ(counts_of(again), want);
    ASSERT_EQ(again.walls.size(), all.walls.size());
    for (std::size_t i = 0; i < all.walls.size(); ++i) {
        EXPECT_EQ(again.walls[i].a, all.walls[i].a);
        EXPECT_EQ(again.walls[i].b, all.walls[i].b);
        EXPECT_EQ(again.walls[i].free_side[left], all.walls[i].free_side[left]);
        EXPECT_EQ(again.walls[i].free_side[right], all.walls[i].free_side[right]);
    }
}

}  // namespace
}  // namespace vfplan
