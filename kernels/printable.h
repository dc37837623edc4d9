// Texts that come from outside, in messages: names of files may hold any byte.
#pragma once

#include <string>
#include <string_view>

namespace vfplan {

// Whether the bytes are UTF-8: none too long, none beyond U+10FFFF, no surrogates.
bool is_utf8(std::string_view text);

// The text as a terminal may be given it:
//  (1) control characters but for the end of a line, and bytes that are no UTF-8, become \x1b and
//      the like: a name cannot move the cursor, colour or rename a window;
//  (2) all else stays, so that printable(printable(t)) == printable(t).
std::string printable(std::string_view text);

}  // namespace vfplan
