// What a terminal is given of names from outside.
#include "kernels/printable.h"

#include <gtest/gtest.h>

namespace vfplan {
namespace {

TEST(Printable, PlainTextStays) {
    for (const char* text : {"", "town.geojson: no such file\nnext line", "caf\xc3\xa9",
                             "\xe2\x82\xac", "\xf0\x9f\x8f\xa0", "back\\x1bslash"}) {
        EXPECT_TRUE(is_utf8(text));
        EXPECT_EQ(printable(text), text);
    }
}

TEST(Printable, WhatMovesACursorIsWrittenOut) {
    EXPECT_EQ(printable("a\x1b[31mb"), "a\\x1b[31mb");
    EXPECT_EQ(printable("\r\b\t\x7f"), "\\x0d\\x08\\x09\\x7f");
    EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a\\x00b");
    EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");  // CSI in one character
    EXPECT_EQ(printable("\xc2\xa0"), "\xc2\xa0");
}

TEST(Printable, BytesThatAreNoUtf8) {
    for (const char* text :
         {"caf\xe9", "\x80", "\xc0\xaf", "\xe0\x80\xaf", "\xed\xa0\x80", "\xf0\x80\x80\x80",
          "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\xe2\x82", "\xc3"}) {
        EXPECT_FALSE(is_utf8(text)) << printable(text);
        EXPECT_TRUE(is_utf8(printable(text)));
        EXPECT_EQ(printable(printable(text)), printable(text));
    }
    EXPECT_EQ(printable("caf\xe9/x"), "caf\\xe9/x");
}

}  // namespace
}  // namespace vfplan
