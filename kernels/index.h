// Signed numbers of things as indices of vectors.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace vfplan {

// REQUIRES: i >= 0.
inline std::size_t idx(std::int64_t i) {
    assert(i >= 0);
    return static_cast<std::size_t>(i);
}

}  // namespace vfplan
