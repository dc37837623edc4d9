// What memory is granted is kept to, and shared out among tasks.
#include "engine/runtime/memory.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <vector>

namespace vfplan {
namespace {

TEST(Memory, TasksAreAsManyAsThereIsRoomFor) {
    EXPECT_EQ(tasks_at_once(0, 8), 8) << "next to nothing";
    EXPECT_EQ(tasks_at_once(1, 8), 8);
    EXPECT_EQ(tasks_at_once(1e18, 8), 1) << "one there must be";
    const double left = memory_left();
    EXPECT_GT(left, 1e6);
    EXPECT_LT(left, memory_limit().bytes);
    const int some = tasks_at_once(left / 3.5, 8);
    EXPECT_GE(some, 2);
    EXPECT_LE(some, 4) << "memory that is left changes from call to call, but not by so much";
}

// In a process of its own: a limit stays.
void expect_refused_beyond(double bytes) {
    limit_memory(bytes, 1);
    const MemoryLimit limit = memory_limit();
    if (limit.bytes != bytes || limit.whose != "--memory grants") std::exit(1);
    if (memory_left() >= bytes) std::exit(2);
    try {
        std::vector<char> within(static_cast<std::size_t>(bytes / 4), 'x');
        if (within.back() != 'x') std::exit(3);
    } catch (const std::bad_alloc&) {
        std::exit(4);
    }
    try {
        std::vector<char> beyond(static_cast<std::size_t>(2 * bytes), 'x');
        std::exit(beyond.back() == 'x' ? 5 : 6);
    } catch (const std::bad_alloc&) {
        std::exit(0);
    }
}

TEST(MemoryDeathTest, WhatIsAskedForBeyondTheLimitIsRefused) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer's own memory knows no such refusal";
#endif
    EXPECT_EXIT(expect_refused_beyond(0x1p28), ::testing::ExitedWithCode(0), "");
}

TEST(MemoryDeathTest, WhatIsGrantedDoesNotRaiseWhatThereIs) {
    EXPECT_EXIT(
        {
            const double there = memory_limit().bytes;
            limit_memory(4 * there, 2);
            std::exit(memory_limit().bytes == there ? 0 : 1);
        },
        ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace vfplan
