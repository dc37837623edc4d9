// From the words in a file (properties, layer names, tags) to roles.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/features/feature.h"
#include "io/features/read_options.h"

namespace vfplan {

// The role that a text stands for by its words: "IfcWallStandardCase", "A-WALL", "glazing", "Tür"
// ... Words are what stands between signs, digits and changes from small to capital letters; only
// whole ones count, in whatever case and in the plural. Of several telling ones the first in the
// order of words_of_roles() decides, so text on a wall is text. Empty when no word says anything.
std::optional<Role> role_of_word(const std::string& text);

// The table behind role_of_word(): roles in the order in which they decide, with their words.
std::vector<std::pair<Role, std::vector<std::string>>> words_of_roles();

// The user's own word: the role of the longest pattern ("A-WALL*"; ? is any sign, * any number of
// them; case does not matter) that a text matches as a whole.
std::optional<Role> role_by_rules(const std::vector<RoleRule>& rules, const std::string& text);

// The role of a feature without any telling word.
Role default_role(SiteKind kind, bool polygon);

}  // namespace vfplan
