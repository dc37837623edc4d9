// From the words in a file (properties, layer names, tags) to roles.
#pragma once

#include <optional>
#include <string>

#include "io/site/feature.h"
#include "io/site/site_options.h"

namespace vfplan {

// The role that a word stands for: "IfcWallStandardCase", "A-WALL", "glazing", "Tür" ... Case
// does not matter; the part of the word that is longest wins. Empty when the word says nothing.
std::optional<Role> role_of_word(const std::string& word);

// The role of a feature without any telling word.
Role default_role(SiteKind kind, bool polygon);

}  // namespace vfplan
