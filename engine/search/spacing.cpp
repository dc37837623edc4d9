#include "engine/search/spacing.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "kernels/index.h"

namespace vfplan {

Sparse nearer_than(std::span<const Vec2d> places, double spacing_m) {
    std::vector<std::pair<double, std::int32_t>> by_x;
    for (std::size_t i = 0; i < places.size(); ++i) {
        by_x.emplace_back(places[i].x(), static_cast<std::int32_t>(i));
    }
    std::sort(by_x.begin(), by_x.end());
    std::vector<std::pair<std::int32_t, std::int32_t>> pairs;
    for (std::size_t i = 0; i < by_x.size(); ++i) {
        const std::int32_t a = by_x[i].second;
        for (std::size_t k = i + 1; k < by_x.size() && by_x[k].first - by_x[i].first < spacing_m;
             ++k) {
            const std::int32_t b = by_x[k].second;
            if ((places[idx(a)] - places[idx(b)]).norm() >= spacing_m) continue;
            pairs.emplace_back(a, b);
            pairs.emplace_back(b, a);
        }
    }
    std::sort(pairs.begin(), pairs.end());
    Sparse out;
    auto pair = pairs.begin();
    for (std::size_t i = 0; i < places.size(); ++i) {
        for (; pair != pairs.end() && idx(pair->first) == i; ++pair) out.to.push_back(pair->second);
        out.end_list();
    }
    return out;
}

}  // namespace vfplan
