#include "engine/generate/generate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <tuple>

#include "kernels/error.h"
#include "kernels/vec.h"

namespace vfplan {
namespace {

using Points = std::vector<Vec2d>;

struct Feature {
    std::string cls;
    std::string label;
    std::string type;
    std::vector<Points> parts;  // rings as written, first point repeated; or one line
};

std::string value_of(const std::string& line, const std::string& key) {
    const std::size_t at = line.find("\"" + key + "\":\"");
    if (at == std::string::npos) return {};
    const std::size_t from = at + key.size() + 4;
    return line.substr(from, line.find('"', from) - from);
}

// One feature a line, as data/README promises; anything else would be noticed by the readers'
// tests.
std::vector<Feature> features(const std::string& geojson) {
    std::vector<Feature> out;
    std::istringstream in(geojson);
    std::string line;
    while (std::getline(in, line)) {
        const std::size_t geometry = line.find("\"geometry\"");
        if (geometry == std::string::npos) continue;
        Feature f{value_of(line, "class"),
                  value_of(line, "label"),
                  value_of(line.substr(geometry), "type"),
                  {{}}};
        for (std::size_t i = line.find("\"coordinates\":") + 14; i < line.size(); ++i) {
            if (line[i] == ']' && line[i + 1] == ',' && line[i + 2] == '[' && line[i + 3] == '[') {
                f.parts.emplace_back();
            }
            if (line[i] != '[' || line[i + 1] == '[') continue;
            std::size_t used = 0;
            const double x = std::stod(line.substr(i + 1), &used);
            f.parts.back().emplace_back(x, std::stod(line.substr(i + 2 + used)));
        }
        out.push_back(f);
    }
    return out;
}

double area_of(const Points& ring) {
    double twice = 0;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        twice += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
    }
    return twice / 2;
}

Box box_of(const Points& ring) {
    Box box;
    for (const Vec2d& p : ring) box.add(p);
    return box;
}

bool cross_properly(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& d) {
    constexpr double eps = 2e-2;  // m2: two walls that touch may differ by a rounded millimetre
    const double c1 = orient(a, b, c);
    const double c2 = orient(a, b, d);
    const double a1 = orient(c, d, a);
    const double a2 = orient(c, d, b);
    return ((c1 > eps && c2 < -eps) || (c1 < -eps && c2 > eps)) &&
           ((a1 > eps && a2 < -eps) || (a1 < -eps && a2 > eps));
}

bool strictly_inside(const Vec2d& p, const Points& ring) {
    bool in = false;
    for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
        const Vec2d& a = ring[i];
        const Vec2d& b = ring[i + 1];
        if ((a.y() > p.y()) != (b.y() > p.y()) &&
            p.x() < a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
            in = !in;
        }
    }
    return in;
}

// Corners drawn 5 mm towards the middle, so that a shared wall is no overlap.
bool has_corner_in(const Points& a, const Points& b) {
    const Box box = box_of(a);
    const Vec2d middle = 0.5 * (box.min + box.max);
    return std::any_of(a.begin(), a.end(), [&](const Vec2d& p) {
        return strictly_inside(p + (middle - p).normalized() * 5e-3, b);
    });
}

bool overlap(const Points& a, const Points& b) {
    for (std::size_t i = 0; i + 1 < a.size(); ++i) {
        for (std::size_t j = 0; j + 1 < b.size(); ++j) {
            if (cross_properly(a[i], a[i + 1], b[j], b[j + 1])) return true;
        }
    }
    return has_corner_in(a, b) || has_corner_in(b, a);
}

int count_overlaps(const std::vector<Feature>& all) {
    std::vector<std::pair<Box, const Points*>> order;
    order.reserve(all.size());
    for (const Feature& f : all) {
        // A courtyard is no footprint, but nothing stands in one of these either.
        order.emplace_back(box_of(f.parts.front()), &f.parts.front());
    }
    std::sort(order.begin(), order.end(),
              [](const auto& a, const auto& b) { return a.first.min.x() < b.first.min.x(); });
    int found = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        for (std::size_t j = i + 1; j < order.size(); ++j) {
            const Box& a = order[i].first;
            const Box& b = order[j].first;
            if (b.min.x() >= a.max.x()) break;
            if (b.min.y() >= a.max.y() || a.min.y() >= b.max.y()) continue;
            if (overlap(*order[i].second, *order[j].second)) ++found;
        }
    }
    return found;
}

void expect_good_rings(const std::vector<Feature>& all) {
    for (const Feature& f : all) {
        if (f.type != "Polygon") continue;
        for (std::size_t k = 0; k < f.parts.size(); ++k) {
            ASSERT_GE(f.parts[k].size(), 5U);
            EXPECT_EQ(f.parts[k].front(), f.parts[k].back());
            if (k == 0) {
                EXPECT_GT(area_of(f.parts[k]), 1.0);
            } else {
                EXPECT_LT(area_of(f.parts[k]), -1.0);
            }
        }
    }
}

GenerateReport make(const std::string& kind, std::uint64_t seed, double size_km = 2,
                    int rooms = 6) {
    return generate_site({kind, seed, size_km, rooms});
}

struct Crop {
    double w, h;
    int buildings;
    double area_m2;
};
constexpr std::array<Crop, 5> paper{{{520, 292, 132, 22059},
                                     {965, 366, 274, 39359},
                                     {976, 441, 379, 49428},
                                     {976, 588, 529, 67448},
                                     {976, 893, 637, 80549}}};

class GenerateTown : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(GenerateTown, HasTheStatisticsOfThePaper) {
    const GenerateReport town = make("town", GetParam());
    const std::vector<Feature> all = features(town.geojson);
    Box extent;
    for (const Feature& f : all) {
        EXPECT_EQ(f.cls, "building");
        for (const Vec2d& p : f.parts[0]) extent.add(p);
    }
    EXPECT_NEAR(extent.size().x(), 976, 2);
    EXPECT_NEAR(extent.size().y(), 893, 2);
    for (const Crop& crop : paper) {
        int count = 0;
        double area = 0;
        for (const Feature& f : all) {
            const Box box = box_of(f.parts[0]);
            const Vec2d c = 0.5 * (box.min + box.max);
            if (c.x() < 0 || c.y() < 0 || c.x() > crop.w || c.y() > crop.h) continue;
            ++count;
            area += area_of(f.parts[0]);
        }
        EXPECT_EQ(count, crop.buildings);
        EXPECT_NEAR(area, crop.area_m2, 0.005 * crop.area_m2);
        // The summary states what is there.
        EXPECT_NE(town.summary.find(std::to_string(crop.buildings) + " buildings"),
                  std::string::npos);
    }
    expect_good_rings(all);
    EXPECT_EQ(count_overlaps(all), 0);
}

TEST_P(GenerateTown, HousesKeepTheirDistanceUnlessTheyTouch) {
    const std::vector<Feature> all = features(make("town", GetParam()).geojson);
    int near = 0;
    std::set<std::pair<double, double>> corners;
    int touching = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t k = 0; k + 1 < all[i].parts[0].size(); ++k) {
            const Vec2d& p = all[i].parts[0][k];
            if (!corners.insert({p.x(), p.y()}).second) ++touching;
            for (std::size_t j = 0; j < all.size(); ++j) {
                if (i == j) continue;
                for (const Vec2d& q : all[j].parts[0]) {
                    const double d = (p - q).norm();
                    if (d > 0.01 && d < 3) ++near;
                }
            }
        }
    }
    EXPECT_EQ(near, 0);
    EXPECT_GE(touching, 20);  // rows and pairs share their corners to the millimetre
}

INSTANTIATE_TEST_SUITE_P(Seeds, GenerateTown, ::testing::Values(1, 2, 3, 7, 20240517));

class GenerateCity : public ::testing::TestWithParam<std::pair<std::uint64_t, double>> {};

TEST_P(GenerateCity, IsDenseEnoughAndFreeOfOverlaps) {
    const auto& [seed, size_km] = GetParam();
    const std::vector<Feature> all = features(make("city", seed, size_km).geojson);
    const double per_km2 = static_cast<double>(all.size()) / (size_km * size_km);
    // A handful of quarters is what chance makes of it; a city settles near 1000.
    const double spread = size_km < 5 ? 0.5 : 0.15;
    EXPECT_NEAR(per_km2, 1000, 1000 * spread);
    Box extent;
    for (const Feature& f : all) {
        EXPECT_EQ(f.cls, "building");
        for (const Vec2d& p : f.parts[0]) extent.add(p);
    }
    const double side = 1000 * size_km;
    EXPECT_TRUE((Box{{0, 0}, {side, side}}.contains(extent.min)));
    EXPECT_TRUE((Box{{0, 0}, {side, side}}.contains(extent.max)));
    EXPECT_GT(extent.size().minCoeff(), 0.85 * side);
    expect_good_rings(all);
    EXPECT_EQ(count_overlaps(all), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, GenerateCity,
                         ::testing::Values(std::pair{1, 0.5}, std::pair{2, 2.0}, std::pair{3, 2.0},
                                           std::pair{4, 5.0}));

TEST(GenerateCity, HasCourtyards) {
    const std::vector<Feature> all = features(make("city", 1, 3).geojson);
    EXPECT_GT(
        std::count_if(all.begin(), all.end(), [](const Feature& f) { return f.parts.size() > 1; }),
        0);
}

class GenerateFlat : public ::testing::TestWithParam<int> {};

// Room at a point, -1 outside.
int room_at(const std::vector<const Feature*>& rooms, const Vec2d& p) {
    for (std::size_t i = 0; i < rooms.size(); ++i) {
        if (strictly_inside(p, rooms[i]->parts[0])) return static_cast<int>(i);
    }
    return -1;
}

TEST_P(GenerateFlat, EveryRoomHasADoorAndIsReachable) {
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U, 5U}) {
        const std::vector<Feature> all = features(make("flat", seed, 2, GetParam()).geojson);
        std::vector<const Feature*> rooms;
        for (const Feature& f : all) {
            if (f.cls == "room") rooms.push_back(&f);
        }
        ASSERT_EQ(static_cast<int>(rooms.size()), GetParam());
        std::vector<int> group(rooms.size());
        std::iota(group.begin(), group.end(), 0);
        const auto find = [&](int i) {
            while (group[static_cast<std::size_t>(i)] != i) i = group[static_cast<std::size_t>(i)];
            return i;
        };
        std::vector<bool> has_door(rooms.size(), false);
        int to_outside = 0;
        for (const Feature& f : all) {
            if (f.cls != "door") continue;
            const Points& line = f.parts[0];
            EXPECT_NEAR((line[1] - line[0]).norm(), 0.9, 1e-9);
            const Vec2d across = 0.05 * Vec2d(-(line[1] - line[0]).y(), (line[1] - line[0]).x());
            const Vec2d middle = 0.5 * (line[0] + line[1]);
            const int a = room_at(rooms, middle + across);
            const int b = room_at(rooms, middle - across);
            for (const int r : {a, b}) {
                if (r >= 0) has_door[static_cast<std::size_t>(r)] = true;
            }
            if (a >= 0 && b >= 0) {
                group[static_cast<std::size_t>(find(a))] = find(b);
            } else {
                ++to_outside;
            }
        }
        EXPECT_EQ(to_outside, 1);
        for (std::size_t i = 0; i < rooms.size(); ++i) {
            EXPECT_TRUE(has_door[i]) << rooms[i]->label;
            EXPECT_EQ(find(static_cast<int>(i)), find(0)) << rooms[i]->label;
            EXPECT_FALSE(rooms[i]->label.empty());
        }
        expect_good_rings(all);
    }
}

// Walls, doors and windows together are exactly the rooms' outlines, each stretch once.
TEST_P(GenerateFlat, WallsDoorsAndWindowsTileTheOutlines) {
    const std::vector<Feature> all = features(make("flat", 9, 2, GetParam()).geojson);
    using Key = std::tuple<bool, long, long>;  // vertical, line in mm, 10 mm step along it
    std::map<Key, int> lines;
    std::map<Key, int> outlines;
    const auto mm = [](double v) { return std::lround(v * 1000); };
    const auto mark = [&](std::map<Key, int>& into, const Vec2d& a, const Vec2d& b) {
        const int axis = mm(a.x()) == mm(b.x()) ? 1 : 0;
        EXPECT_EQ(mm(a[1 - axis]), mm(b[1 - axis]));
        for (long s = std::min(mm(a[axis]), mm(b[axis])); s < std::max(mm(a[axis]), mm(b[axis]));
             s += 10) {
            ++into[{axis == 1, mm(a[1 - axis]), s}];
        }
    };
    std::set<std::string> classes;
    for (const Feature& f : all) {
        classes.insert(f.cls);
        const Points& p = f.parts[0];
        for (std::size_t i = 0; i + 1 < p.size(); ++i)
            mark(f.cls == "room" ? outlines : lines, p[i], p[i + 1]);
    }
    EXPECT_EQ(classes, (std::set<std::string>{"door", "room", "wall", "window"}));
    EXPECT_EQ(lines.size(), outlines.size());
    for (const auto& [key, count] : lines) {
        EXPECT_EQ(count, 1);
        EXPECT_EQ(outlines.count(key), 1U);
    }
}

INSTANTIATE_TEST_SUITE_P(Rooms, GenerateFlat,
                         ::testing::Values(2, 3, 4, 6, 9, 14, 15, 40, 60, 200));

TEST(Generate, EqualSeedsGiveEqualBytesAndOthersDiffer) {
    for (const char* kind : {"town", "city", "flat"}) {
        const GenerateReport a = make(kind, 5, 1);
        const GenerateReport b = make(kind, 5, 1);
        const GenerateReport c = make(kind, 6, 1);
        EXPECT_EQ(a.geojson, b.geojson) << kind;
        EXPECT_EQ(a.summary, b.summary) << kind;
        EXPECT_NE(a.geojson, c.geojson) << kind;
    }
}

TEST(Generate, FileFollowsTheConventions) {
    const std::string text = make("flat", 1).geojson;
    EXPECT_EQ(
        text.rfind(
            R"({"type":"FeatureCollection","name":"Synthetic flat, seed 1, 6 rooms","units":"m")",
            0),
        0U);
    EXPECT_EQ(text.substr(text.size() - 4), "\n]}\n");
    EXPECT_EQ(std::count(text.begin(), text.end(), '{'), std::count(text.begin(), text.end(), '}'));
    EXPECT_EQ(std::count(text.begin(), text.end(), '['), std::count(text.begin(), text.end(), ']'));
}

TEST(Generate, WrongOptionsAreUsageErrors) {
    EXPECT_THROW(make("village", 1), UsageError);
    EXPECT_THROW(make("", 1), UsageError);
    EXPECT_THROW(make("city", 1, 0.4), UsageError);
    EXPECT_THROW(make("city", 1, 61), UsageError);
    EXPECT_THROW(make("city", 1, std::numeric_limits<double>::quiet_NaN()), UsageError);
    EXPECT_THROW(make("flat", 1, 2, 1), UsageError);
    EXPECT_THROW(make("flat", 1, 2, 201), UsageError);
}

}  // namespace
}  // namespace vfplan
