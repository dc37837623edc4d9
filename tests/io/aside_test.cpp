// Files in the making: never through a link, never half a file, nothing left of what failed.
#include "io/aside.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "io/files.h"
#include "io/h5_writer.h"
#include "io/temporary_folder.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

namespace fs = std::filesystem;

class AsideTest : public ::testing::Test {
protected:
    fs::path at(const std::string& name) const { return folder_.path() / name; }
    std::size_t names() const {
        return static_cast<std::size_t>(
            std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
    }

private:
    TemporaryFolder folder_{"vfplan-aside"};
};

TEST_F(AsideTest, NothingIsWrittenThroughALink) {
    std::ofstream(at("victim")) << "victim";
    for (const char* name : {"text", "table", "package"}) {
        fs::create_symlink(at("victim"), at(std::string(name) + ".tmp"));
    }
    write_text(at("text"), "ours");
    h5::Writer table(at("table"));
    table.close();
    {
        Aside package(at("package"), true);
        std::ofstream(package.path()) << "ours";
        package.publish();
    }
    EXPECT_EQ(read_text(at("victim")), "victim");
    EXPECT_EQ(read_text(at("text")), "ours");
    EXPECT_EQ(read_text(at("package")), "ours");
    EXPECT_EQ(names(), 4U);
    // A link under the name itself is replaced, not followed.
    fs::create_symlink(at("victim"), at("name"));
    write_text(at("name"), "ours");
    EXPECT_EQ(read_text(at("victim")), "victim");
    EXPECT_FALSE(fs::is_symlink(at("name")));
}

TEST_F(AsideTest, WhatAKilledProcessLeftIsNoHindrance) {
    std::ofstream(at("text.tmp")) << "half of";
    fs::create_directory(at("package.tmp"));
    for (const char* name : {"package", "package-journal", "package-wal"}) {
        std::ofstream(at("package.tmp") / name) << "half of";
    }
    write_text(at("text"), "whole");
    Aside package(at("package"), true);
    EXPECT_TRUE(fs::is_empty(at("package.tmp")));
}

TEST_F(AsideTest, NothingStaysOfWhatIsNotPublished) {
    {
        TextFile text(at("text"));
        text.add("half of");
        Aside package(at("package"), true);
        std::ofstream(package.path()) << "half of";
        h5::Writer table(at("table"));
        EXPECT_EQ(names(), 3U);
    }
    EXPECT_EQ(names(), 0U);
}

TEST_F(AsideTest, WhatIsThereAlreadyIsNotOpened) {
    Aside file(at("text"));
    std::ofstream(file.path()) << "somebody else's";
    EXPECT_THROW(file.create(), IoError);
    EXPECT_EQ(read_text(file.path()), "somebody else's");
}

// In a process of its own, which ends by it.
TEST_F(AsideTest, AForcedEndLeavesNothing) {
    const auto die = [&] {
        TextFile text(at("text"));
        text.add("half of");
        Aside package(at("package"), true);
        std::ofstream(package.path()) << "half of";
        std::ofstream(package.path().string() + "-journal") << "half of";
        std::ofstream(at("stays")) << "whole";
        remove_asides();
        _exit(75);
    };
    EXPECT_EXIT(die(), ::testing::ExitedWithCode(75), "");
    EXPECT_EQ(names(), 1U);
    EXPECT_TRUE(fs::exists(at("stays")));
}

}  // namespace
}  // namespace vfplan
