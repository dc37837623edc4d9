// The door to libpng: pictures in memory to PNG.
#pragma once

#include <cstdint>
#include <string>

namespace vfplan {

// A PNG of pixels 0x00RRGGBB, row by row from the top, `stride` of them from one row to the next:
// quickly rather than as small as possible. Throws IoError, which names `what`.
std::string png_of(const std::uint32_t* pixels, int width, int height, int stride,
                   const std::string& what);

}  // namespace vfplan
