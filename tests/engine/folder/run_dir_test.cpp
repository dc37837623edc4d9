// Whose a folder is, and what of it may be removed.
#include "engine/folder/run_dir.h"

#include <gtest/gtest.h>

#include <fstream>

#include "engine/folder/claim.h"
#include "engine/folder/contents.h"
#include "io/files.h"
#include "io/temporary_folder.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

namespace fs = std::filesystem;

class RunDirTest : public ::testing::Test {
protected:
    RunDirTest() {
        config.site.input = folder.path() / "site.geojson";
        write(config.site.input, "{}");
        keys = job_keys(config, "input");
    }

    static void write(const fs::path& file, const std::string& text) {
        fs::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }

    // A folder as a run leaves it half-way.
    RunDir begun(const std::string& name) const {
        const RunDir dir(folder.path() / name);
        ClaimedFolder claim(dir, config, keys, false);
        claim.keep();
        for (const char* file :
             {"work/site.h5", "work/tiles-64/joints-00003.h5", "work/tiles-64/splits-00000.h5.tmp",
              "work/tiles-64/disputed-0-00001.h5", "work/tiles-64/components-joined-00000.h5",
              "shards/field-64-00000.h5", "shards/coverage-00000.h5", "field.h5", "coverage.h5",
              "pool.h5", "plan.h5", "summary.json", "stations.csv", "provenance.json"}) {
            write(dir.file(file), "ours");
        }
        return dir;
    }

    static std::string message_of(const std::function<void()>& f) {
        try {
            f();
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    }

    TemporaryFolder folder{"vfplan-run-dir"};
    Config config;
    JobKeys keys;
};

TEST_F(RunDirTest, AnEmptyFolderMayBecomeOurs) {
    const RunDir dir(folder.path() / "new");
    dir.check(keys, false);
    fs::create_directory(dir.path());
    dir.check(keys, false);
    EXPECT_THROW(dir.check_ours(), UsageError);
    {
        ClaimedFolder claim(dir, config, keys, false);
        claim.keep();
    }
    dir.check_ours();
    dir.check(keys, false);
    EXPECT_THROW(dir.check({"other", "other"}, false), UsageError);
    dir.check({"other", "other"}, true);
}

TEST_F(RunDirTest, AProjectOfTheUserIsNotOurs) {
    const RunDir dir(folder.path() / "project");
    write(dir.file("job.toml"), "preset = \"outdoor\"\n");
    write(dir.file("work/thesis.tex"), "precious");
    for (const bool fresh : {false, true}) EXPECT_THROW(dir.check(keys, fresh), UsageError);
    // Not even with a job.toml that was copied from a run of ours, which has the two lines.
    fs::copy_file(begun("run").file("job.toml"), dir.file("job.toml"),
                  fs::copy_options::overwrite_existing);
    for (const bool fresh : {false, true}) EXPECT_THROW(dir.check(keys, fresh), UsageError);
    EXPECT_TRUE(fs::exists(dir.file("work/thesis.tex")));
    // Nor with a mark, when the two lines are missing.
    fs::copy_file(folder.path() / "run" / lock_name, dir.file(lock_name));
    write(dir.file("job.toml"), "preset = \"outdoor\"\n");
    for (const bool fresh : {false, true}) EXPECT_THROW(dir.check(keys, fresh), UsageError);
}

TEST_F(RunDirTest, FreshWritesOverNoJobThatWasChangedByHand) {
    const RunDir dir = begun("run");
    std::ofstream(dir.file("job.toml"), std::ios::app) << "# my notes\n";
    EXPECT_NE(message_of([&] { dir.check(keys, true); }).find("changed by hand"),
              std::string::npos);
}

TEST_F(RunDirTest, AnotherVersionsShardsAreRefusedByName) {
    const RunDir dir = begun("run");
    std::string text = read_text(dir.file("job.toml"));
    const std::string version = " tables " + std::to_string(tables_version) + "\n";
    text.replace(text.find(version), version.size(), " tables 1\n");
    const std::string key = "# job ";
    text.replace(text.find(key) + key.size(), 1, text[key.size()] == '0' ? "1" : "0");
    write_text(dir.file("job.toml"), text);
    EXPECT_NE(message_of([&] { dir.check(keys, false); }).find("another vfplan"),
              std::string::npos);
    dir.check(keys, true);
}

TEST_F(RunDirTest, OnlyWhatWeWriteIsRemoved) {
    const RunDir dir = begun("run");
    const std::vector<std::string> theirs = {"work/thesis.tex",
                                             "work/tiles-64/notes.txt",
                                             "work/tiles-64/field-notes.h5",
                                             "work/tiles/joints-0.h5",
                                             "shards/my-coverage.h5",
                                             "shards/coverage-x.h5",
                                             "shards/deep/coverage-00000.h5",
                                             "notes.txt",
                                             "field.h5.bak",
                                             "plan.csv"};
    for (const std::string& name : theirs) write(dir.file(name), "precious");
    dir.remove_run();
    for (const std::string& name : theirs) EXPECT_TRUE(fs::exists(dir.file(name))) << name;
    for (const std::string& name : theirs) fs::remove(dir.file(name));
    for (const char* name : {"work/tiles-64", "work/tiles", "shards/deep"}) {
        fs::remove(dir.file(name));
    }
    dir.remove_run();
    for (const auto& left : fs::directory_iterator(dir.path())) {
        const std::string name = left.path().filename();
        EXPECT_TRUE(name == "job.toml" || name == lock_name || name == "work" || name == "shards")
            << name;
    }
}

TEST_F(RunDirTest, LinksAreRefusedAndNeverFollowed) {
    for (const char* name : {"summary.json", "plan.h5", "work", "shards", "work/tiles-64",
                             "shards/coverage-00000.h5", "work/site.h5", "job.toml"}) {
        const RunDir dir = begun("run");
        const fs::path elsewhere = folder.path() / "elsewhere";
        fs::remove_all(elsewhere);
        fs::rename(dir.file(name), elsewhere);
        fs::create_symlink(elsewhere, dir.file(name));
        EXPECT_NE(message_of([&] { dir.check(keys, true); }).find("symbolic link"),
                  std::string::npos)
            << name;
        const bool is_folder = fs::is_directory(elsewhere);
        const bool had = is_folder && !fs::is_empty(elsewhere);
        dir.remove_run();
        EXPECT_TRUE(fs::exists(elsewhere)) << name;
        EXPECT_EQ(is_folder && !fs::is_empty(elsewhere), had) << name;
        fs::remove_all(dir.path());
    }
}

TEST_F(RunDirTest, AJobThatNeverBeganLeavesNothing) {
    const RunDir dir(folder.path() / "a" / "b");
    { const ClaimedFolder claim(dir, config, keys, false); }
    EXPECT_FALSE(fs::exists(folder.path() / "a"));
}

TEST(Contents, NamesOfShards) {
    for (const char* name : {"field-64-00000.h5", "coverage-00012.h5", "pool-100000.h5.tmp"}) {
        EXPECT_TRUE(is_shard_name(name)) << name;
    }
    for (const char* name : {"field.h5", "coverage-.h5", "xcoverage-00000.h5", "coverage-00000.h5x",
                             "../coverage-00000.h5", "pool-1.csv", ""}) {
        EXPECT_FALSE(is_shard_name(name)) << name;
    }
    EXPECT_TRUE(is_passing_name("joins.h5"));
    EXPECT_FALSE(is_passing_name("thesis.h5"));
}

}  // namespace
}  // namespace vfplan
