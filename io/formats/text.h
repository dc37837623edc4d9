// What readers of text formats share: numbers, and places for messages.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace vfplan {

// Line and column of a byte, from 1: "12:5".
std::string place_in(const std::string& text, std::size_t byte);

// The finite number that a text is as a whole, without spaces; empty when it is none. Like
// std::from_chars, whatever the locale.
template <class Number>
std::optional<Number> number_in(std::string_view text) {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = error == std::errc() && end == text.data() + text.size();
    return whole && std::isfinite(static_cast<double>(value)) ? std::optional(value) : std::nullopt;
}

}  // namespace vfplan
