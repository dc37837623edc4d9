// Original files against the GeoJSON that was made of them with other programs: the same walls.
#include <gtest/gtest.h>

#include <cstdio>
#include <optional>

#include "io/formats/read_features.h"
#include "tests/data.h"
#include "tests/io/formats/walls_apart.h"

namespace vfplan {
namespace {

using test::apart;
using test::Apart;
using test::indoor;

// Both ways, with the file moved to where the GeoJSON has its origin; without a move, the lower
// left corners of their extents are laid on each other.
Apart compared(const std::string& raw, const std::string& geojson, const SiteOptions& options,
               std::optional<Vec2d> move = {}) {
    const Site a = read_site(test::data_dir() / raw, options).site;
    const Site b = read_site(test::data_dir() / geojson, options).site;
    if (!move) move = b.origin + b.extent.min - a.origin - a.extent.min;
    return apart(a, b, *move);
}

TEST(RawFiles, Delft) {
    VFPLAN_NEED_DATA("town_delft/raw/delft.json");
    const Apart d = compared("town_delft/raw/delft.json", "town_delft/delft_full.geojson", {},
                             Vec2d(-84616.468, -447422.999));
    std::printf("Delft: %s\n", d.text().c_str());
    EXPECT_EQ(d.wrong_m, 0) << d.text();
}

TEST(RawFiles, HouseExpo) {
    VFPLAN_NEED_DATA("plan_houseexpo/raw");
    const Apart d = compared("plan_houseexpo/raw/0a1b29dba355df2ab02630133187bfab.json",
                             "plan_houseexpo/houseexpo_0a1b29db.geojson", indoor(), Vec2d(0, 0));
    std::printf("HouseExpo: %s\n", d.text().c_str());
    EXPECT_EQ(d.wrong_m, 0) << d.text();
    EXPECT_EQ(d.slits_m, 0) << d.text();
}

// The GeoJSON ends free walls half their thickness later than Sweet Home 3D draws them, joins some
// bluntly, and lacks crumbs of wall between two doors.
TEST(RawFiles, Arlington) {
    VFPLAN_NEED_DATA("plan_arlington_school/raw/Home.xml");
    const Apart d =
        compared("plan_arlington_school/raw/Home.xml",
                 "plan_arlington_school/arlington_school.geojson", indoor(), Vec2d(-2, 122));
    std::printf("Arlington: %s\n", d.text().c_str());
    EXPECT_LT(d.wrong_m, 0.004 * d.length_m[0]) << d.text();
}

// The file has a door as a place on a room's border; where it lies near a corner that is hardly
// one, the two readings open the wall elsewhere, 20 of 1,251 doors.
TEST(RawFiles, OfficesAndSchools) {
    VFPLAN_NEED_DATA("plans_offices_schools/raw");
    int files = 0;
    int equal = 0;
    double wrong_m = 0;
    double all_m = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(test::data_dir() / "plans_offices_schools/raw")) {
        const std::string name = entry.path().stem().string();
        const std::string raw = "plans_offices_schools/raw/" + name + ".xml";
        const std::string geojson = "plans_offices_schools/" + name + ".geojson";
        const Apart d = compared(raw, geojson, indoor());
        EXPECT_LT(d.wrong_m, 0.012 * d.length_m[0]) << name << ": " << d.text();
        wrong_m += d.wrong_m;
        all_m += d.length_m[0];
        equal += d.wrong_m == 0;
        ++files;
    }
    std::printf("offices and schools: %.2f m of %.2f m apart, %d files not at all\n", wrong_m,
                all_m, equal);
    EXPECT_EQ(files, 25);
    EXPECT_GE(equal, 12);
    EXPECT_LT(wrong_m, 0.0015 * all_m);
}

TEST(RawFiles, ArtGalleries) {
    VFPLAN_NEED_DATA("agp");
    int files = 0;
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(test::data_dir() / "agp")) {
        if (entry.path().extension() != ".pol") continue;
        SiteOptions options = indoor();
        options.unit_m = 1;
        const FeatureSet a = read_features(entry.path(), options);
        std::filesystem::path other = entry.path();
        const FeatureSet b = read_features(other.replace_extension(".geojson"), options);
        ASSERT_EQ(a.features.size(), 1U);
        ASSERT_EQ(b.features.size(), 1U);
        const Polygon& p = a.features[0].polygons.at(0);
        const Polygon& q = b.features[0].polygons.at(0);
        EXPECT_EQ(a.features[0].role, Role::outline);
        int wrong = 0;
        // Holes came out in the other direction.
        const auto same = [&](Ring r, Ring t) {
            ASSERT_EQ(r.size(), t.size()) << entry.path();
            for (Ring* ring : {&r, &t}) {
                std::sort(ring->begin(), ring->end(), [](const Vec2d& u, const Vec2d& v) {
                    return std::pair(u.x(), u.y()) < std::pair(v.x(), v.y());
                });
            }
            for (std::size_t i = 0; i < r.size(); ++i) {
                wrong += (r[i] - t[i]).norm() > 1e-9 * t[i].norm();
            }
        };
        same(p.outer, q.outer);
        ASSERT_EQ(p.holes.size(), q.holes.size()) << entry.path();
        for (std::size_t i = 0; i < p.holes.size(); ++i) same(p.holes[i], q.holes[i]);
        EXPECT_EQ(wrong, 0) << entry.path();
        ++files;
    }
    EXPECT_EQ(files, 49);
}

}  // namespace
}  // namespace vfplan
