// Reads back the PNG files that map_png writes (8-bit RGB, not interlaced), so that tests can ask
// for pixels without another library.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace vfplan::testing {

struct PngPixels {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;

    std::array<int, 3> at(int x, int y) const;
};

// Throws std::runtime_error for anything else than such a file.
PngPixels read_png(const std::string& bytes);

}  // namespace vfplan::testing
