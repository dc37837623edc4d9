// The filters of a dataset's chunk, done by the thread that has the data: shuffle, deflate,
// fletcher32, in this order, as any HDF5 reader undoes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vfplan {

inline constexpr int deflate_level = 1;  // higher ones gain few percent and cost several times more

// `width`: bytes of a value. Thread-safe.
std::vector<std::uint8_t> pack_chunk(const std::uint8_t* data, std::size_t size, std::size_t width);

}  // namespace vfplan
