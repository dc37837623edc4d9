// Locks: one leader at a time, whoever the others are, and never an open door.
#include "engine/folder/lock.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "io/temporary_folder.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

namespace fs = std::filesystem;
using Hold = FolderLock::Hold;

constexpr auto brief = std::chrono::milliseconds(800);

class LockTest : public ::testing::Test {
protected:
    // The exit code of a process that does something: 0, or 1 for an IoError.
    static int apart(const std::function<void()>& f, bool as_nobody = false) {
        const pid_t child = ::fork();
        if (child == 0) {
            if (as_nobody && (::setgid(65534) != 0 || ::setuid(65534) != 0)) _exit(3);
            try {
                f();
                _exit(0);
            } catch (const IoError&) {
                _exit(1);
            } catch (...) {
                _exit(2);
            }
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        return WEXITSTATUS(status);
    }

    TemporaryFolder folder{"vfplan-lock"};
};

TEST_F(LockTest, ItMarksTheFolder) {
    EXPECT_FALSE(is_marked(folder.path()));
    { const FolderLock lock(folder.path(), Hold::lead); }
    EXPECT_TRUE(is_marked(folder.path()));
    { const FolderLock lock(folder.path(), Hold::lead); }
    EXPECT_EQ(fs::file_size(folder.path() / lock_name), 21U);
}

// flock() belongs to the open file, so one process can stand for two.
TEST_F(LockTest, ASecondLeaderWaitsForTheFirst) {
    auto first = std::make_unique<FolderLock>(folder.path(), Hold::lead);
    bool gone = false;
    std::thread end([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        gone = true;
        first.reset();
    });
    const FolderLock second(folder.path(), Hold::lead);
    EXPECT_TRUE(gone);
    end.join();
}

TEST_F(LockTest, ALeaderWaitsForFollowersOfTheOneBefore) {
    auto leader = std::make_unique<FolderLock>(folder.path(), Hold::lead);
    auto follower = std::make_unique<FolderLock>(folder.path(), Hold::follow);
    const FolderLock another(folder.path(), Hold::follow);  // they share
    leader.reset();                                         // as if killed
    EXPECT_EQ(apart([&] {
                  const int file = ::open((folder.path() / ranks_name).c_str(), O_RDWR);
                  if (file < 0) throw IoError("");
              }),
              0);
    std::thread end([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        follower.reset();
    });
    // `another` lives on.
    EXPECT_THROW(FolderLock(folder.path(), Hold::lead, brief), IoError);
    end.join();
}

TEST_F(LockTest, CopiersShareAndKeepLeadersOut) {
    const FolderLock one(folder.path(), Hold::copy);
    const FolderLock two(folder.path(), Hold::copy);
    EXPECT_THROW(FolderLock(folder.path(), Hold::lead, brief), IoError);
}

// The first job made the folder and takes it away again, with the lock that the second waits for.
TEST_F(LockTest, WhoeverWaitsForALockThatGoesAwayTakesTheNext) {
    auto first = std::make_unique<FolderLock>(folder.path(), Hold::lead);
    std::thread end([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(400));
        first->remove();
        first.reset();
    });
    const FolderLock second(folder.path(), Hold::lead);
    end.join();
    EXPECT_TRUE(is_marked(folder.path()));
    EXPECT_EQ(apart([&] { const FolderLock third(folder.path(), Hold::copy, brief); }), 1);
}

TEST_F(LockTest, AnotherUsersLockHolds) {
    if (::geteuid() != 0) GTEST_SKIP() << "only root can be two users";
    fs::permissions(folder.path(), fs::perms::all);
    auto mine = std::make_unique<FolderLock>(folder.path(), Hold::lead);
    fs::permissions(folder.path() / lock_name, fs::perms(0644));
    const auto take = [&] { const FolderLock lock(folder.path(), Hold::lead, brief); };
    EXPECT_EQ(apart(take, true), 1);  // it is held
    mine.reset();
    EXPECT_EQ(apart(take, true), 0);  // readable is enough
    fs::permissions(folder.path() / lock_name, fs::perms::none);
    EXPECT_EQ(apart(take, true), 1);  // it cannot be looked at: no free folder
}

TEST_F(LockTest, ALinkIsNoLock) {
    fs::create_symlink(folder.path() / "elsewhere", folder.path() / lock_name);
    EXPECT_THROW(FolderLock(folder.path(), Hold::lead), IoError);
    EXPECT_FALSE(fs::exists(folder.path() / "elsewhere"));
}

}  // namespace
}  // namespace vfplan
