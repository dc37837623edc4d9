#include "engine/generate/town_crops.h"

#include <algorithm>
#include <cmath>

namespace vfplan::generate {

std::string describe_town(const std::vector<RingMm>& buildings, std::uint64_t seed) {
    BoxMm all = box_of(buildings.at(0));
    std::array<int, rings> count{};
    std::array<double, rings> area{};
    for (const RingMm& b : buildings) {
        const BoxMm box = box_of(b);
        all.min = {std::min(all.min.x, box.min.x), std::min(all.min.y, box.min.y)};
        all.max = {std::max(all.max.x, box.max.x), std::max(all.max.y, box.max.y)};
        const double x = static_cast<double>(box.min.x + box.max.x) / 2000;
        const double y = static_cast<double>(box.min.y + box.max.y) / 2000;
        for (std::size_t k = 0; k < rings; ++k) {
            if (x > crops[k].w || y > crops[k].h) continue;
            ++count[k];
            area[k] += area_m2(b);
        }
    }
    std::string out = "synthetic town, seed " + std::to_string(seed) + "\n";
    out += "  buildings " + std::to_string(buildings.size()) + ", built area " +
           grouped(std::llround(area[rings - 1])) + " m2, mean footprint " +
           fixed(area[rings - 1] / static_cast<double>(buildings.size()), 1) + " m2\n";
    out += "  extent " + fixed(static_cast<double>(all.max.x - all.min.x) / 1000, 1) + " x " +
           fixed(static_cast<double>(all.max.y - all.min.y) / 1000, 1) + " m\n";
    out += "  crops from the south-west corner (by the centre of a building's bounding box):\n";
    for (std::size_t k = 0; k < rings; ++k) {
        out += "    " + fixed(crops[k].w, 0) + " x " + fixed(crops[k].h, 0) +
               " m: " + std::to_string(count[k]) + " buildings, " + grouped(std::llround(area[k])) +
               " m2\n";
    }
    return out;
}

}  // namespace vfplan::generate
