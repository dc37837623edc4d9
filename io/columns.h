// Columns of a table in HDF5.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/h5_writer.h"
#include "kernels/names.h"

namespace vfplan {

// Turns a member of every element into a column.
template <class T, class Items, class F>
std::vector<T> column(const Items& items, F&& value) {
    std::vector<T> out;
    out.reserve(items.size());
    for (const auto& item : items) out.push_back(static_cast<T>(value(item)));
    return out;
}

// Says what the numbers of a dataset mean.
inline void write_code_names(h5::Writer& file, const std::string& name,
                             std::span<const std::string_view> names) {
    std::string meaning;
    for (std::size_t i = 0; i < names.size(); ++i) {
        meaning += (i > 0 ? ", " : "") + std::to_string(i) + " " + std::string(names[i]);
    }
    file.attribute(name, "meaning", meaning);
}

// A column of an enumeration's values with what they mean.
template <class E>
void write_codes(h5::Writer& file, const std::string& name, const std::vector<E>& codes) {
    file.write(name, column<std::uint8_t>(codes, [](E e) { return e; }));
    write_code_names(file, name, names_of<E>());
}

}  // namespace vfplan
