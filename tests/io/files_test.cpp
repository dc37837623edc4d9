// Small files, whole or not at all.
#include "io/files.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kernels/error.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

TEST(Files, ATextFileThatComesBitByBit) {
    const test::TemporaryFile file("bits.csv");
    std::filesystem::path aside = file.path();
    aside += ".tmp";
    {
        TextFile out(file.path());
        out.add("a,b\n");
        for (int i = 0; i < 10000; ++i) out.add(fmt::format("{},1\n", i));
        EXPECT_FALSE(std::filesystem::exists(file.path()));
        out.close();
    }
    EXPECT_FALSE(std::filesystem::exists(aside));
    const std::string text = read_text(file.path());
    EXPECT_EQ(text.substr(0, 8), "a,b\n0,1\n");
    EXPECT_EQ(text.substr(text.size() - 7), "9999,1\n");
    {
        TextFile out(file.path());  // given up: the old one stays
        out.add("new");
    }
    EXPECT_EQ(read_text(file.path()), text);
    EXPECT_FALSE(std::filesystem::exists(aside));
    EXPECT_THROW(TextFile("no/such/file"), IoError);
}

TEST(Files, TextIsWrittenWholeAndReadBack) {
    const test::TemporaryFile file("text.csv");
    write_text(file.path(), std::string("a\0b\n", 4));
    EXPECT_EQ(read_text(file.path()), std::string("a\0b\n", 4));
    write_text(file.path(), "short");
    EXPECT_EQ(read_text(file.path()), "short");
    EXPECT_THROW(read_text("no/such/file"), IoError);
    EXPECT_THROW(write_text("no/such/file", "x"), IoError);
}

}  // namespace
}  // namespace vfplan
