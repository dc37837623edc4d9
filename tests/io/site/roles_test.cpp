#include "io/site/roles.h"

#include <gtest/gtest.h>

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
    EXPECT_EQ(role_of_word("A-ANNO-TEXT"), Role::drawing);
}

TEST(Roles, CaseDoesNotMatter) {
    for (const char* word : {"wall", "WALL", "Wall", "wAlL"}) {
        EXPECT_EQ(role_of_word(word), Role::wall);
    }
}

TEST(Roles, LongestPartWins) {
    EXPECT_EQ(role_of_word("room_bbox"), Role::drawing);
    EXPECT_EQ(role_of_word("window_wall"), Role::window);
    EXPECT_EQ(role_of_word("wall_text"), role_of_word("text_wall"));
}

TEST(Roles, SilentWords) {
    for (const char* word : {"", "0", "xyz", "yes", "Layer1"}) {
        EXPECT_FALSE(role_of_word(word).has_value()) << word;
    }
}

TEST(Roles, WithoutAWordTheShapeDecides) {
    EXPECT_EQ(default_role(SiteKind::outdoor, true), Role::building);
    EXPECT_EQ(default_role(SiteKind::outdoor, false), Role::wall);
    EXPECT_EQ(default_role(SiteKind::indoor, true), Role::outline);
    EXPECT_EQ(default_role(SiteKind::indoor, false), Role::wall);
}

}  // namespace
}  // namespace vfplan
