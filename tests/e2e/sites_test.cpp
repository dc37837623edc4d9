// Real sites at the settings they are planned with: every plan verified, every piece accounted for.
#include "program.h"

namespace vfplan::test {
namespace {

struct Case {
    const char* name;
    const char* file;
    const char* config;
    const char* kernel;
    bool whole;  // must become one network that covers every coverable piece
};

void expect_networks_listed(const Json& s) {
    const double threshold = s["overlap"]["threshold"];
    const Json& list = s["network_list"];
    ASSERT_EQ(list.size(), s["networks"].get<std::size_t>());
    std::int64_t stations = 0;
    for (std::size_t i = 0; i < list.size(); ++i) {
        stations += list[i]["stations"].get<std::int64_t>();
        EXPECT_GT(list[i]["length_m"].get<double>(), 0) << "network " << i;
        const double joins = list[i]["joins_main_at"];
        if (i == 0) {
            EXPECT_EQ(joins, 1);
        } else {
            // It would be one with the main one at a lower threshold, or at none.
            EXPECT_GE(joins, 0) << "network " << i;
            EXPECT_LT(joins, threshold) << "network " << i;
        }
    }
    EXPECT_EQ(stations, s["stations"].get<std::int64_t>());
}

void expect_pieces_accounted_for(const Json& s, const Path& dir) {
    auto status = read_csv(dir / "pieces.csv").counts("status");
    for (const auto& [name, count] : status) {
        EXPECT_TRUE(name == "covered" || name == "no_viewpoint" || name == "off_candidates" ||
                    name == "unreached")
            << count << " pieces are " << name;
    }
    EXPECT_EQ(status["covered"], s["pieces_covered"].get<std::int64_t>());
    EXPECT_EQ(status["unreached"], s["pieces_unreached"].get<std::int64_t>());
    EXPECT_EQ(s["pieces"].get<std::int64_t>() - status["no_viewpoint"],
              s["pieces_coverable"].get<std::int64_t>());
    // A piece that some free cell sees gets a rescue candidate.
    EXPECT_EQ(status["off_candidates"], 0);
    if (s["networks"] == 1) {
        EXPECT_EQ(status["unreached"], 0);
    }
}

void PrintTo(const Case& c, std::ostream* out) { *out << c.file << ", kernel " << c.kernel; }

class Sites : public ::testing::TestWithParam<Case> {};

TEST_P(Sites, EveryPlanHolds) {
    const Case& c = GetParam();
    VFPLAN_NEED_DATA(c.file);
    const Scratch scratch;
    const Path dir = scratch / "run";
    vfplan_expect(
        0, with_sets({"run", config_file(c.config), "--out", dir, "--quiet"},
                     {"site.input=" + data_file(c.file),
                      std::string("visibility.kernel=") + c.kernel, "output.formats=['csv']"}));
    vfplan_expect(0, {"verify", dir});
    const Json s = read_json(dir / "summary.json");
    expect_networks_listed(s);
    expect_pieces_accounted_for(s, dir);
    if (c.whole) {
        EXPECT_EQ(s["networks"], 1);
        EXPECT_EQ(s["pieces_covered"], s["pieces_coverable"]);
    }
}

// Helsinki's perimeter blocks enclose courtyards, which only networks of their own can cover; so
// does a closet of the house.
const auto sites = [](const char* kernel) {
    return std::vector<Case>{
        {"bellevue", "town_bellevue/bellevue_976x893.geojson", "town.toml", kernel, true},
        {"bellevue_b", "town_bellevue/bellevue_b_976x893.geojson", "town.toml", kernel, true},
        {"karhula", "town_karhula/karhula_976x893.geojson", "town.toml", kernel, true},
        {"helsinki", "town_helsinki_centre/helsinki_centre_full.geojson", "town.toml", kernel,
         false},
        {"apartment", "plan_houseexpo/houseexpo_0a1b29db.geojson", "office.toml", kernel, true},
        {"house", "plan_house_overland/house_overland.geojson", "office.toml", kernel, false},
        {"milano", "plans_offices_schools/office_milano_1.geojson", "office.toml", kernel, true},
        {"elm", "plans_offices_schools/office_324_elm_furn_plan.geojson", "office.toml", kernel,
         true},
        {"off_2", "plans_offices_schools/office_off_2.geojson", "office.toml", kernel, true},
        {"borchen", "plans_offices_schools/school_borchen4.geojson", "office.toml", kernel, true},
        {"franch", "plans_offices_schools/school_franch1.geojson", "office.toml", kernel, true},
    };
};

const auto named = [](const auto& i) { return std::string(i.param.name); };
INSTANTIATE_TEST_SUITE_P(Exact, Sites, ::testing::ValuesIn(sites("exact")), named);
INSTANTIATE_TEST_SUITE_P(Embree, Sites, ::testing::ValuesIn(sites("embree")), named);

}  // namespace
}  // namespace vfplan::test
