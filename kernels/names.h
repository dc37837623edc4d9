// Enumerations that people write or read.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string_view>

namespace vfplan {

// Names<E>::all: a name for each value of E, in their order; specialised beside each enumeration.
// REQUIRES of E: values from 0 on, std::uint8_t underneath.
template <class E>
struct Names;

template <class E>
constexpr std::span<const std::string_view> names_of() {
    return Names<E>::all;
}

template <class E>
constexpr std::string_view name_of(E value) {
    return Names<E>::all[static_cast<std::size_t>(value)];
}

}  // namespace vfplan
