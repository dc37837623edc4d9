// Texts that nest too deep for a parser are told before it sees them.
#include "engine/config/toml_depth.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "engine/config/config.h"
#include "kernels/error.h"

namespace vfplan {
namespace {

std::string times(int n, const std::string& text) {
    std::string out;
    for (int i = 0; i < n; ++i) out += text;
    return out;
}

std::string refusal(const std::string& text, const std::vector<std::string>& sets = {}) {
    try {
        parse_config(text, "job.toml", "/", sets);
    } catch (const UsageError& e) {
        return e.what();
    }
    return "";
}

TEST(TomlDepth, WhatJobsHoldIsNotDeep) {
    for (const char* text :
         {"", "[site]\ninput = \"a.geojson\"\n", "plan.required = [[1.5, 2.5], [3.5,\n 4.5]]\n",
          "x = '''...........................'''\n", "# ..............................\n",
          "x = \"[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\\\"...............................\"\n",
          "roles = { 'a.b.c' = 'wall', \"d.e\" = 'wall' }\n"}) {
        EXPECT_FALSE(too_deep(text)) << text;
    }
    std::string many;
    for (int i = 0; i < 200; ++i) many += fmt::format("a{}.b.c = [1.5, 2.5]\n[x{}.y]\n", i, i);
    EXPECT_FALSE(too_deep(many));
    const std::string numbers = "x = [" + times(500, "1.5, ") + "]\n";
    EXPECT_FALSE(too_deep(numbers));
    EXPECT_FALSE(too_deep("v = " + times(40, "../") + "town.geojson"));  // a value of --set
}

TEST(TomlDepth, EveryWayDownIsSeenWithItsPlace) {
    const std::string deep = times(50000, "a.") + "a";
    for (const std::string& text :
         {deep + " = 1", "\n\n[" + deep + "]\n", "[[" + deep + "]]", "x = {" + deep + " = 1}",
          "x = {b = 1, " + deep + " = 1}", "x = [\n{" + deep + " = 1}]", "[a\n" + deep + " = 1",
          "x = " + times(50000, "["), "x = " + times(50000, "{a = "),
          "x = " + times(50000, "[{a = "), times(50000, "'a'.") + "a = 1",
          times(50000, "\"a\" . ") + "a = 1", "x = 'a\n" + deep + " = 1",
          "x = [1, 2]\n" + deep + " = 1", "[a]\n" + deep + " = 1"}) {
        EXPECT_TRUE(too_deep(text)) << text.substr(0, 40);
        EXPECT_NE(refusal(text).find("job.toml"), std::string::npos) << text.substr(0, 40);
    }
    const auto at = too_deep("\n\nx = " + times(30, "["));
    ASSERT_TRUE(at);
    EXPECT_EQ(at->line, 3U);
    EXPECT_EQ(at->column, 5U + toml_depth_most);
    const std::string said = refusal("\n" + deep + " = 1");
    EXPECT_NE(said.find("job.toml:2:"), std::string::npos) << said;
    EXPECT_LT(said.size(), 300U);
    const std::string set = refusal("site.input = 'a'", {"site.roles=" + times(50000, "[")});
    EXPECT_NE(set.find("--set site.roles"), std::string::npos) << set;
}

TEST(TomlDepth, AtTheLimitAllIsParsedAndRefusedInWords) {
    std::string key = times(toml_depth_most, "a.") + "a";
    std::string text = key + " = 1";
    for (int i = 1; i < toml_depth_most; ++i) text = key + " = {" + text + "}";
    EXPECT_FALSE(too_deep(text));
    EXPECT_NE(refusal(text).find("no such parameter"), std::string::npos);
}

}  // namespace
}  // namespace vfplan
