// What the paper says of its town and of five crops of it, all from the south-west corner (appendix
// "Time and Space Complexity").
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/generate/drawing.h"

namespace vfplan::generate {

inline constexpr double town_w = 976;
inline constexpr double town_h = 893;

// Ring k holds what crop k holds beyond crop k - 1.
struct Crop {
    double w, h;
    int buildings;
    double area_m2;
    double civic_m2;  // of the ring: about what its large buildings take
};
inline constexpr int rings = 5;
inline constexpr std::array<Crop, rings> crops{{{520, 292, 132, 22059, 4600},
                                                {965, 366, 274, 39359, 2300},
                                                {976, 441, 379, 49428, 500},
                                                {976, 588, 529, 67448, 1700},
                                                {976, 893, 637, 80549, 1500}}};

// Buildings and built area that ring r has to have.
inline int ring_count(int r) {
    const auto k = static_cast<std::size_t>(r);
    return crops[k].buildings - (r > 0 ? crops[k - 1].buildings : 0);
}
inline double ring_area(int r) {
    const auto k = static_cast<std::size_t>(r);
    return crops[k].area_m2 - (r > 0 ? crops[k - 1].area_m2 : 0);
}
// `rings` beyond the last.
inline int ring_of(double x, double y) {
    for (int r = 0; r < rings; ++r) {
        const auto& c = crops[static_cast<std::size_t>(r)];
        if (x <= c.w && y <= c.h) return r;
    }
    return rings;
}

// The statistics of what was generated, for people.
std::string describe_town(const std::vector<RingMm>& buildings, std::uint64_t seed);

}  // namespace vfplan::generate
