// Where tests find real sites, and what to do when they are not there.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

namespace vfplan::test {

// $VFPLAN_DATA, else ../shared/data beside the source tree.
inline std::filesystem::path data_dir() {
    if (const char* dir = std::getenv("VFPLAN_DATA"); dir != nullptr && *dir != '\0') {
        return dir;
    }
    return (std::filesystem::path(VFPLAN_SOURCE_DIR) / ".." / "shared" / "data").lexically_normal();
}

inline bool have_data() { return std::filesystem::is_directory(data_dir()); }

// True where missing data must fail a test instead of skipping it (VFPLAN_REQUIRE_DATA=1).
inline bool require_data() {
    const char* value = std::getenv("VFPLAN_REQUIRE_DATA");
    return value != nullptr && std::string_view(value) == "1";
}

inline std::string missing_data_message(const std::filesystem::path& path) {
    return "test data missing: " + (data_dir() / path).string() +
           " (set VFPLAN_DATA to the folder that holds it)";
}

}  // namespace vfplan::test

// First line of a test that reads `path` (relative to data_dir()): skips the test when the file is
// missing, or fails it under VFPLAN_REQUIRE_DATA=1.
#define VFPLAN_NEED_DATA(path)                                               \
    do {                                                                     \
        if (!std::filesystem::exists(::vfplan::test::data_dir() / (path))) { \
            if (::vfplan::test::require_data()) {                            \
                FAIL() << ::vfplan::test::missing_data_message(path);        \
            }                                                                \
            GTEST_SKIP() << ::vfplan::test::missing_data_message(path);      \
        }                                                                    \
    } while (false)
