// Loops over indices and how many threads there are.
#include "engine/runtime/parallel.h"

#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <mutex>
#include <numeric>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace vfplan {
namespace {

// Sets or (nullptr) unsets a variable, and puts back what was there.
class Variable {
public:
    Variable(const char* name, const char* value) : name_(name) {
        if (const char* old = std::getenv(name)) old_ = old;
        set(value);
    }
    ~Variable() { set(old_ ? old_->c_str() : nullptr); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    void set(const char* value) { value == nullptr ? unsetenv(name_) : setenv(name_, value, 1); }
    const char* name_;
    std::optional<std::string> old_;
};

// Every part asks whether it may go on, and is short enough that it asks often.
TEST(Threads, MayBeToldToEnd) {
    std::atomic<int> asked = 0;
    std::atomic<int> done = 0;
    const Threads threads(2, [&] {
        if (++asked > 10) throw std::runtime_error("enough");
    });
    EXPECT_THROW(threads.for_each(10000, 8,
                                  [&](std::int64_t from, std::int64_t to) {
                                      EXPECT_LE(to - from, 8);
                                      done += static_cast<int>(to - from);
                                  }),
                 std::runtime_error);
    EXPECT_LE(done, 80);
}

TEST(Threads, EveryIndexIsVisitedOnce) {
    for (const int count : {1, 2, 4}) {
        const Threads threads(count);
        for (const std::int64_t n : {1, 2, 15, 16, 17, 1000, 12345}) {
            for (const std::int64_t grain : {1, 3, 16, 20000}) {
                std::vector<std::atomic<int>> visits(static_cast<std::size_t>(n));
                threads.for_each(n, grain, [&](std::int64_t from, std::int64_t to) {
                    EXPECT_LT(from, to);
                    for (std::int64_t i = from; i < to; ++i) ++visits[static_cast<std::size_t>(i)];
                });
                for (const auto& v : visits) ASSERT_EQ(v, 1) << n << " by " << grain;
            }
        }
    }
}

TEST(Threads, PartsHaveAtLeastHalfAGrainOfIndices) {
    std::atomic<std::int64_t> least = 17;
    Threads(2).for_each(17, 16, [&](std::int64_t from, std::int64_t to) {
        least = std::min(least.load(), to - from);
    });
    EXPECT_GE(least, 8);
}

TEST(Threads, NothingToDoCallsNothing) {
    Threads(2).for_each(0, 4, [](std::int64_t, std::int64_t) { FAIL(); });
}

TEST(Threads, LoopsSeeWhatCameBeforeAndAreSeenByWhatComesAfter) {
    const Threads threads(2);
    std::vector<std::int64_t> numbers(1000);
    std::iota(numbers.begin(), numbers.end(), 0);
    for (int round = 0; round < 50; ++round) {
        for (auto& v : numbers) ++v;  // plain, between loops
        threads.for_each(1000, 8, [&](std::int64_t from, std::int64_t to) {
            for (std::int64_t i = from; i < to; ++i) ++numbers[static_cast<std::size_t>(i)];
        });
    }
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        EXPECT_EQ(numbers[i], static_cast<std::int64_t>(i) + 100);
    }
}

TEST(Threads, LoopsMayBeNested) {
    const Threads threads(2);
    std::vector<std::vector<int>> table(40, std::vector<int>(40, 0));
    threads.for_each(40, 1, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t y = from; y < to; ++y) {
            auto& row = table[static_cast<std::size_t>(y)];
            threads.for_each(40, 4, [&](std::int64_t a, std::int64_t b) {
                for (std::int64_t x = a; x < b; ++x) ++row[static_cast<std::size_t>(x)];
            });
        }
    });
    for (const auto& row : table) EXPECT_EQ(row, std::vector<int>(40, 1));
}

TEST(Threads, ExceptionsArriveAndTheThreadsWorkOn) {
    for (const int count : {1, 2}) {
        const Threads threads(count);
        for (int round = 0; round < 20; ++round) {
            try {
                threads.for_each(100, 1, [](std::int64_t from, std::int64_t to) {
                    if (from <= 60 && 60 < to) throw std::runtime_error("index 60");
                });
                ADD_FAILURE() << "nothing thrown";
            } catch (const std::runtime_error& e) {
                EXPECT_STREQ(e.what(), "index 60");
            }
        }
        std::atomic<int> done = 0;
        threads.for_each(100, 1, [&](std::int64_t from, std::int64_t to) {
            done += static_cast<int>(to - from);
        });
        EXPECT_EQ(done, 100);
    }
    EXPECT_THROW(Threads(2).run([] { throw std::logic_error("inside"); }), std::logic_error);
}

TEST(Threads, RunRunsOnce) {
    int runs = 0;
    Threads(2).run([&] { ++runs; });
    EXPECT_EQ(runs, 1);
}

TEST(Threads, NoMoreThreadsWorkThanAskedFor) {
    for (const std::size_t count : {1U, 2U, 3U}) {
        const Threads threads(static_cast<int>(count));
        EXPECT_EQ(threads.count(), static_cast<int>(count));
        std::mutex mutex;
        std::set<std::thread::id> ids;
        threads.for_each(2000, 1, [&](std::int64_t, std::int64_t) {
            const std::lock_guard lock(mutex);
            ids.insert(std::this_thread::get_id());
        });
        EXPECT_LE(ids.size(), count);
    }
}

TEST(Threads, SlurmSaysHowManyUnlessTheJobDoes) {
    {
        const Variable slurm("SLURM_CPUS_PER_TASK", "1");
        EXPECT_EQ(Threads().count(), 1);
        EXPECT_EQ(Threads(0).count(), 1);
        EXPECT_EQ(Threads(2).count(), 2);
    }
    // No more than this process may use, whatever it says.
    const Variable slurm("SLURM_CPUS_PER_TASK", "100000");
    cpu_set_t set;
    ASSERT_EQ(sched_getaffinity(0, sizeof set, &set), 0);
    EXPECT_EQ(Threads().count(), CPU_COUNT(&set));
}

TEST(Threads, WithoutSlurmTheProcessorsCount) {
    int processors = 0;
    {
        const Variable none("SLURM_CPUS_PER_TASK", nullptr);
        processors = Threads().count();
    }
    EXPECT_GE(processors, 1);
    EXPECT_LE(processors, static_cast<int>(std::thread::hardware_concurrency()));
    for (const char* nonsense : {"", "many", "0", "-2"}) {
        const Variable slurm("SLURM_CPUS_PER_TASK", nonsense);
        EXPECT_EQ(Threads().count(), processors) << nonsense;
    }
}

}  // namespace
}  // namespace vfplan
