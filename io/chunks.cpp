#include "io/chunks.h"

#include <zlib.h>

#include <algorithm>

#include "kernels/error.h"

namespace vfplan {
namespace {

// Byte k of every value next to each other.
std::vector<std::uint8_t> shuffled(const std::uint8_t* data, std::size_t size, std::size_t width) {
    std::vector<std::uint8_t> out(size);
    const std::size_t values = size / width;
    for (std::size_t k = 0; k < width; ++k) {
        std::uint8_t* to = out.data() + k * values;
        const std::uint8_t* from = data + k;
        for (std::size_t i = 0; i < values; ++i) to[i] = from[i * width];
    }
    return out;
}

// Fletcher's checksum over 16-bit words, the high byte first, as HDF5 takes it.
std::uint32_t fletcher32(const std::vector<std::uint8_t>& data) {
    constexpr std::size_t before_overflow = 360;  // words that 32 bits can sum
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    const auto fold = [](std::uint32_t v) { return (v & 0xffffU) + (v >> 16U); };
    const std::size_t words = (data.size() + 1) / 2;
    for (std::size_t from = 0; from < words; from += before_overflow) {
        for (std::size_t w = from; w < std::min(words, from + before_overflow); ++w) {
            const std::uint32_t second = 2 * w + 1 < data.size() ? data[2 * w + 1] : 0;
            low += static_cast<std::uint32_t>(data[2 * w]) << 8U | second;
            high += low;
        }
        low = fold(low);
        high = fold(high);
    }
    return fold(high) << 16U | fold(low);
}

}  // namespace

std::vector<std::uint8_t> pack_chunk(const std::uint8_t* data, std::size_t size,
                                     std::size_t width) {
    const std::vector<std::uint8_t> bytes = shuffled(data, size, width);
    uLongf packed = compressBound(size);
    std::vector<std::uint8_t> out(packed + 4);
    if (compress2(out.data(), &packed, bytes.data(), size, deflate_level) != Z_OK) {
        throw IoError("a chunk cannot be compressed; is there memory left?");
    }
    out.resize(packed);
    const std::uint32_t sum = fletcher32(out);
    for (unsigned k = 0; k < 4; ++k) out.push_back(static_cast<std::uint8_t>(sum >> (8 * k)));
    return out;
}

}  // namespace vfplan
