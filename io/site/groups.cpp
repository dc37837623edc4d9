#include "io/site/groups.h"

#include <algorithm>
#include <numeric>

namespace vfplan {

std::vector<std::vector<std::size_t>> neighbour_groups(const std::vector<Box>& boxes,
                                                       double near_m) {
    std::vector<std::size_t> by_x(boxes.size());
    std::iota(by_x.begin(), by_x.end(), std::size_t{0});
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(boxes[a].min.x(), a) < std::pair(boxes[b].min.x(), b);
    });
    std::vector<std::size_t> leader(boxes.size());
    std::iota(leader.begin(), leader.end(), std::size_t{0});
    const auto find = [&](std::size_t i) {
        while (leader[i] != i) i = leader[i] = leader[leader[i]];
        return i;
    };
    std::vector<std::size_t> open;  // boxes that may still reach the sweep's place
    for (const std::size_t i : by_x) {
        if (boxes[i].empty()) continue;
        std::erase_if(open,
                      [&](std::size_t k) { return boxes[k].max.x() + near_m < boxes[i].min.x(); });
        for (const std::size_t k : open) {
            if (boxes[k].min.y() > boxes[i].max.y() + near_m ||
                boxes[i].min.y() > boxes[k].max.y() + near_m) {
                continue;
            }
            const std::size_t a = find(i);
            const std::size_t b = find(k);
            leader[std::max(a, b)] = std::min(a, b);
        }
        open.push_back(i);
    }
    std::vector<std::vector<std::size_t>> groups(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) groups[find(i)].push_back(i);
    std::erase_if(groups, [](const std::vector<std::size_t>& g) { return g.empty(); });
    return groups;
}

}  // namespace vfplan
