#include "io/features/roles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace vfplan {
namespace {

TEST(Roles, WordsOfManyTrades) {
    EXPECT_EQ(role_of_word("building"), Role::building);
    EXPECT_EQ(role_of_word("IfcWallStandardCase"), Role::wall);
    EXPECT_EQ(role_of_word("A-WALL"), Role::wall);
    EXPECT_EQ(role_of_word("pillar"), Role::wall);
    EXPECT_EQ(role_of_word("glazing"), Role::window);
    EXPECT_EQ(role_of_word("IfcDoor"), Role::door);
    EXPECT_EQ(role_of_word("Tür"), Role::door);
    EXPECT_EQ(role_of_word("TÜREN"), Role::door);
    EXPECT_EQ(role_of_word("fenêtre"), Role::window);
    EXPECT_EQ(role_of_word("I-FURN"), Role::obstacle);
    EXPECT_EQ(role_of_word("IfcSpace"), Role::room);
    EXPECT_EQ(role_of_word("outline"), Role::outline);
    EXPECT_EQ(role_of_word("A-ANNO-TEXT"), Role::ignored);
}

TEST(Roles, CaseDoesNotMatter) {
    for (const char* word : {"wall", "WALL", "Wall", "wAlL"}) {
        EXPECT_EQ(role_of_word(word), Role::wall);
    }
}

TEST(Roles, TheFirstTellingRoleOfTheTableDecides) {
    EXPECT_EQ(role_of_word("room_bbox"), Role::ignored);
    EXPECT_EQ(role_of_word("window_wall"), Role::window);
    EXPECT_EQ(role_of_word("wall_text"), Role::ignored);
    EXPECT_EQ(role_of_word("text_wall"), Role::ignored);
    EXPECT_EQ(role_of_word("WALL-FURN"), Role::obstacle);
}

TEST(Roles, OnlyWholeWordsCount) {
    for (const char* word : {"STREET-FACADE", "Streetfront", "street", "portal", "dimmer", "murky",
                             "spaceship", "wallpaper", "Wandschrank", "indoor"}) {
        EXPECT_FALSE(role_of_word(word).has_value()) << word;
    }
    EXPECT_EQ(role_of_word("walls"), Role::wall);
    EXPECT_EQ(role_of_word("A2-WALL3"), Role::wall);
    EXPECT_EQ(role_of_word("innerWall"), Role::wall);
    EXPECT_EQ(role_of_word("tree row"), Role::obstacle);
}

TEST(Roles, SilentWords) {
    for (const char* word : {"", "0", "xyz", "yes", "Layer1"}) {
        EXPECT_FALSE(role_of_word(word).has_value()) << word;
    }
}

TEST(Roles, ThePageOfWordsIsTheTable) {
    std::ifstream in(std::string(VFPLAN_SOURCE_DIR) + "/docs/roles.md");
    const std::string page{std::istreambuf_iterator<char>(in), {}};
    std::string want;
    for (const auto& [role, words] : words_of_roles()) {
        want += fmt::format("| {} | {} |\n", name_of(role), fmt::join(words, ", "));
    }
    EXPECT_NE(page.find(want), std::string::npos) << want;
}

TEST(Roles, RulesOfTheUser) {
    const std::vector<RoleRule> rules = {{"A-WALL*", Role::wall},
                                         {"A-WALL-DEMO", Role::ignored},
                                         {"?", Role::room},
                                         {"*glass", Role::window}};
    EXPECT_EQ(role_by_rules(rules, "a-wall-ext"), Role::wall);
    EXPECT_EQ(role_by_rules(rules, "A-WALL"), Role::wall);
    EXPECT_EQ(role_by_rules(rules, "A-Wall-Demo"), Role::ignored);  // the longer pattern
    EXPECT_EQ(role_by_rules(rules, "0"), Role::room);
    EXPECT_EQ(role_by_rules(rules, "shower glass"), Role::window);
    EXPECT_FALSE(role_by_rules(rules, "XA-WALL").has_value());
    EXPECT_FALSE(role_by_rules(rules, "").has_value());
    EXPECT_FALSE(role_by_rules({}, "wall").has_value());
}

TEST(Roles, WithoutAWordTheShapeDecides) {
    EXPECT_EQ(default_role(SiteKind::outdoor, true), Role::building);
    EXPECT_EQ(default_role(SiteKind::outdoor, false), Role::wall);
    EXPECT_EQ(default_role(SiteKind::indoor, true), Role::outline);
    EXPECT_EQ(default_role(SiteKind::indoor, false), Role::wall);
}

}  // namespace
}  // namespace vfplan
