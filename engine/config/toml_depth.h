// How deep a TOML text nests, looked at before it is parsed: the parser calls itself for each
// level.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace vfplan {

// Brackets in brackets, and parts of a dotted key: more than any job file has use for, and little
// enough for a stack even where every bracket holds such a key.
inline constexpr int toml_depth_most = 20;

struct TextPlace {
    std::uint32_t line = 1;
    std::uint32_t column = 1;  // in bytes
};

// Where a text first nests deeper; nothing if it never does. Reads once from begin to end and keeps
// to what stands in strings and comments; of a text that is no TOML it may give any answer, as the
// parser ends there.
std::optional<TextPlace> too_deep(std::string_view toml);

}  // namespace vfplan
