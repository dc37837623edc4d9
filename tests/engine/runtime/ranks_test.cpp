// The properties of Ranks that hold for one process; e2e/ranks_test.cpp has those of several.
#include "engine/runtime/ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <latch>
#include <mutex>
#include <vector>

#include "engine/runtime/ending.h"
#include "engine/runtime/exit_code.h"
#include "engine/runtime/launch.h"
#include "engine/runtime/stop.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

TEST(Ranks, AloneIsLeaderOfOne) {
    const Ranks ranks;
    EXPECT_EQ(ranks.rank(), 0);
    EXPECT_EQ(ranks.count(), 1);
    EXPECT_TRUE(ranks.leader());
    EXPECT_EQ(binding_warning(), "");
    EXPECT_FALSE(Ranks::built_with().empty());
    ranks.wait();
    int led = 0;
    ranks.lead([&] { ++led; });
    EXPECT_EQ(led, 1);
    EXPECT_TRUE(ranks.fail(3));
}

TEST(Ranks, EachTaskOnce) {
    const Ranks ranks;
    for (const int count : {1, 2, 5}) {
        const Threads threads(count);
        for (const std::int64_t n : {0, 1, 4, 1000}) {
            std::vector<std::atomic<int>> done(static_cast<std::size_t>(n));
            ranks.share(threads, n, [&](std::int64_t i) { ++done[static_cast<std::size_t>(i)]; });
            EXPECT_TRUE(
                std::all_of(done.begin(), done.end(), [](const auto& d) { return d == 1; }));
        }
    }
}

TEST(Ranks, LanesRunAtTheSameTime) {
    const Ranks ranks;
    const Threads threads(3);
    std::latch all(3);
    ranks.share(threads, 3, [&](std::int64_t) { all.arrive_and_wait(); });
}

TEST(Ranks, TasksAreHandedOutInOrder) {
    const Ranks ranks;
    std::vector<std::int64_t> order;
    ranks.share(Threads(1), 100, [&](std::int64_t i) { order.push_back(i); });
    EXPECT_EQ(order.size(), 100U);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

// A thread that waits in a task's own loop does not begin another task on top of it.
TEST(Ranks, TasksDoNotNest) {
    const Ranks ranks;
    const Threads threads(4);
    std::atomic<bool> nested = false;
    ranks.share(threads, 200, [&](std::int64_t) {
        thread_local bool busy = false;
        if (busy) nested = true;
        busy = true;
        std::atomic<std::int64_t> sum = 0;
        threads.for_each(100, 1, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t k = from; k < to; ++k) sum += k;
        });
        EXPECT_EQ(sum, 4950);
        busy = false;
    });
    EXPECT_FALSE(nested);
}

TEST(Ranks, LowestFailingTaskIsToBlame) {
    const Ranks ranks;
    const Threads threads(4);
    for (int repeat = 0; repeat < 50; ++repeat) {
        std::atomic<int> begun = 0;
        try {
            ranks.share(threads, 1000, [&](std::int64_t i) {
                ++begun;
                if (i % 10 == 7) throw InputError("task " + std::to_string(i));
            });
            FAIL() << "no exception";
        } catch (const InputError& e) {
            EXPECT_STREQ(e.what(), "task 7");
        }
        EXPECT_LT(begun, 1000);
    }
}

TEST(Ranks, LeaderFails) {
    const Ranks ranks;
    EXPECT_THROW(ranks.lead([] { throw IoError("full"); }), IoError);
}

TEST(RanksDeathTest, SignalStopsBehindTheTaskInHand) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto stopped = [](int signal) {
        watch_signals();
        std::exit(run_to_end([&](const Ranks& ranks) {
            ranks.share(Threads(2), 1 << 30, [&](std::int64_t i) {
                if (i == 10) std::raise(signal);
            });
            return 0;
        }));
    };
    EXPECT_EXIT(stopped(SIGTERM), ::testing::ExitedWithCode(75), "stopped by a signal");
    EXPECT_EXIT(stopped(SIGINT), ::testing::ExitedWithCode(75), "stopped by a signal");
    EXPECT_EXIT(stopped(SIGUSR1), ::testing::ExitedWithCode(75), "stopped by a signal");
}

TEST(RanksDeathTest, ManyProcessesThatDoNotKnowOfEachOther) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto begin = [](const char* rank) {
        for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"}) unsetenv(name);
        setenv("SLURM_STEP_NUM_TASKS", "3", 1);
        setenv("SLURM_PROCID", rank, 1);
        std::exit(run_to_end([](const Ranks&) { return 0; }));
    };
    EXPECT_EXIT(begin("0"), ::testing::ExitedWithCode(2), "3 processes were started");
    EXPECT_EXIT(begin("1"), ::testing::ExitedWithCode(2), "^$");
}

TEST(Ending, CodesAndMessages) {
    const auto of = [](auto error) { return ending_of(std::make_exception_ptr(error)); };
    EXPECT_EQ(of(InputError("x")).code, 3);
    EXPECT_EQ(of(InputError("x")).message, "x");
    EXPECT_EQ(of(Stopped("x")).code, 75);
    EXPECT_EQ(of(std::bad_alloc()).code, 4);
    EXPECT_EQ(of(std::logic_error("x")).code, 70);
    EXPECT_EQ(of(1).code, 70);
}

}  // namespace
}  // namespace vfplan
