// Plans appear as one: what summary.json vouches for.
#include "engine/folder/publication.h"

#include <gtest/gtest.h>

#include <fstream>
#include <random>

#include "engine/folder/contents.h"
#include "io/files.h"
#include "io/temporary_folder.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

using Json = nlohmann::ordered_json;

class PublicationTest : public ::testing::Test {
protected:
    PublicationTest() {
        for (const char* name :
             {"job.toml", "provenance.json", "plan.h5", "stations.csv", "plan.gpkg"}) {
            write_text(folder.path() / name, std::string("what is in ") + name + "\n");
        }
        publish_plan(folder.path(), {{"stations", 3}, {"wapl", 1.0 / 3}, {"note", "caf\xc3\xa9"}});
    }

    std::vector<std::string> faults() const { return faults_since_published(folder.path()); }

    TemporaryFolder folder{"vfplan-publication"};
};

TEST_F(PublicationTest, WhatWasWrittenIsAsItWas) {
    EXPECT_TRUE(faults().empty());
    const Json summary = Json::parse(read_text(folder.path() / "summary.json"));
    EXPECT_EQ(summary["stations"], 3);
    EXPECT_EQ(summary["files"].size(), 5U);
    // Published again it vouches for what is there then.
    write_text(folder.path() / "stations.csv", "other\n");
    EXPECT_EQ(faults().size(), 1U);
    publish_plan(folder.path(), summary);
    EXPECT_TRUE(faults().empty());
}

TEST_F(PublicationTest, OneByteOfAnyFileIsNamed) {
    std::mt19937_64 random(7);
    for (const char* name :
         {"job.toml", "provenance.json", "plan.h5", "stations.csv", "plan.gpkg", "summary.json"}) {
        const std::string whole = read_text(folder.path() / name);
        for (int i = 0; i < 100; ++i) {
            std::string changed = whole;
            changed[random() % whole.size()] ^= static_cast<char>(1U << (random() % 8));
            write_text(folder.path() / name, changed);
            const std::vector<std::string> found = faults();
            ASSERT_EQ(found.size(), 1U) << name << "\n" << changed;
            EXPECT_EQ(found[0].find(name), 0U) << found[0];
        }
        write_text(folder.path() / name, whole);
    }
    EXPECT_TRUE(faults().empty());
}

TEST_F(PublicationTest, WhatIsMissingOrTooMuchIsNamed) {
    std::filesystem::remove(folder.path() / "plan.gpkg");
    write_text(folder.path() / "links.csv", "of another plan\n");
    write_text(folder.path() / "notes.txt", "the user's\n");
    const std::vector<std::string> found = faults();
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0], "links.csv: belongs to no plan here");
    EXPECT_EQ(found[1], "plan.gpkg: missing");
}

TEST_F(PublicationTest, WithoutSummaryThereIsNoPlan) {
    withdraw_plan(folder.path());
    EXPECT_THROW(faults(), IoError);
    withdraw_plan(folder.path());  // again: nothing is there
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "plan.h5"));
}

}  // namespace
}  // namespace vfplan
