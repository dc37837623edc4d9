// The combinations that a sweep plans.
#include "engine/compare/sweep.h"

#include <gtest/gtest.h>

#include <set>

#include "kernels/error.h"

namespace vfplan {
namespace {

TEST(SweepRuns, AreEveryCombinationWithTheLastKeyFastest) {
    const auto runs = sweep_runs({"a.x=1,2", "b.y=5", "c.z=p,q,r"});
    std::vector<std::string> names;
    for (const SweepRun& run : runs) names.push_back(run.name);
    EXPECT_EQ(names, (std::vector<std::string>{"a.x=1,c.z=p", "a.x=1,c.z=q", "a.x=1,c.z=r",
                                               "a.x=2,c.z=p", "a.x=2,c.z=q", "a.x=2,c.z=r"}));
    EXPECT_EQ(runs[4].swept, (std::vector<std::string>{"a.x=2", "c.z=q"}));
    EXPECT_EQ(runs[4].all, (std::vector<std::string>{"a.x=2", "b.y=5", "c.z=q"}));
}

TEST(SweepRuns, PartListsAndTextsOnlyBetweenThem) {
    const auto runs = sweep_runs({"site.crop_m=[0,0,1,1],[0,0,2,2]", "site.layer=\"A,B\",'C,D'",
                                  "site.roles={a = 1, b = 2}"});
    ASSERT_EQ(runs.size(), 4U);
    EXPECT_EQ(runs[3].all, (std::vector<std::string>{"site.crop_m=[0,0,2,2]", "site.layer='C,D'",
                                                     "site.roles={a = 1, b = 2}"}));
}

TEST(SweepRuns, HaveFoldersOfTheirOwn) {
    const auto runs = sweep_runs({"site.input=a/b.json,a b.json,../a_b.json"});
    std::set<std::string> names;
    for (const SweepRun& run : runs) {
        EXPECT_EQ(run.name.find('/'), std::string::npos) << run.name;
        names.insert(run.name);
    }
    EXPECT_EQ(names.size(), 3U);
}

TEST(SweepRuns, RefuseWhatIsNoSweep) {
    EXPECT_THROW(sweep_runs({}), UsageError);
    EXPECT_THROW(sweep_runs({"a.x=1", "b.y=[1,2]"}), UsageError);
    EXPECT_THROW(sweep_runs({"a.x=1,,2"}), UsageError);
    EXPECT_THROW(sweep_runs({"a.x=1,2,"}), UsageError);
    EXPECT_THROW(sweep_runs({"a.x"}), UsageError);
    const std::string ten = "=0,1,2,3,4,5,6,7,8,9";
    EXPECT_EQ(sweep_runs({"a" + ten, "b" + ten, "c" + ten}).size(), 1000U);
    EXPECT_THROW(sweep_runs({"a" + ten, "b" + ten, "c" + ten, "d=1,2"}), UsageError);
}

}  // namespace
}  // namespace vfplan
