// What columns of a table must keep to before they are used: a file under a right checksum may
// still say anything, and nothing is indexed by what it says unless it was looked at here. All
// throw the IoError of a damaged file, naming the column.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "io/h5_reader.h"
#include "kernels/names.h"

namespace vfplan::sound {

inline constexpr double farthest_m = 1e9;  // of a coordinate; sites lie within 1e8

inline void need(const h5::Reader& file, bool good, const std::string& name, const char* what) {
    if (!good) file.fail(fmt::format("{} {}", name, what));
}

// As many values as there are rows.
template <class T>
void count(const h5::Reader& file, const std::string& name, const std::vector<T>& values,
           std::size_t rows) {
    if (values.size() == rows) return;
    file.fail(fmt::format("{} has {} values, not {}", name, values.size(), rows));
}

// least <= value < end, each.
template <class T>
void range(const h5::Reader& file, const std::string& name, const std::vector<T>& values,
           std::int64_t least, std::int64_t end) {
    for (const T v : values) {
        if (static_cast<std::int64_t>(v) >= least && static_cast<std::int64_t>(v) < end) continue;
        file.fail(fmt::format("{} has a value {}, not from {} to {}", name, v, least, end - 1));
    }
}

// Values of an enumeration.
template <class E>
void codes(const h5::Reader& file, const std::string& name,
           const std::vector<std::uint8_t>& values) {
    range(file, name, values, 0, static_cast<std::int64_t>(names_of<E>().size()));
}

// Finite, none beyond `most` either way.
template <class T>
void finite(const h5::Reader& file, const std::string& name, const std::vector<T>& values,
            double most = farthest_m) {
    for (const T v : values) {
        need(file, std::abs(static_cast<double>(v)) <= most, name, "has a value that cannot be");
    }
}

// Where rows begin, and the end behind the last: from `first` on, ascending, to `end`.
template <class T>
void offsets(const h5::Reader& file, const std::string& name, const std::vector<T>& begin,
             std::size_t rows, std::int64_t first, std::int64_t end) {
    count(file, name, begin, rows + 1);
    need(file,
         static_cast<std::int64_t>(begin.front()) == first &&
             static_cast<std::int64_t>(begin.back()) == end,
         name, "does not begin or end where its rows do");
    for (std::size_t i = 0; i < rows; ++i) {
        need(file, begin[i] <= begin[i + 1], name, "does not ascend");
    }
}

}  // namespace vfplan::sound
