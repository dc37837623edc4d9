#include "engine/plan/order.h"

#include <queue>
#include <unordered_set>

#include "kernels/index.h"

namespace vfplan {
Chosen in_order(const PlanInput& in, const Chosen& network,
                const std::vector<std::uint8_t>& covered, Workspace& work) {
    if (network.empty()) return {};
    std::vector<std::uint8_t>& waiting = work.mark;
    for (const std::int32_t c : network) waiting[idx(c)] = 1;
    std::unordered_set<std::int32_t> fresh;  // pieces covered since
    const auto gain_m = [&](std::int32_t c) {
        double sum = 0;
        for (const std::int32_t p : in.rows.row(c)) {
            if (covered[idx(p)] == 0 && !fresh.contains(p)) sum += in.piece_length_m[idx(p)];
        }
        return sum;
    };
    std::priority_queue<FrontierEntry> queue;
    FrontierEntry first{-1, 0, -1};
    for (const std::int32_t c : network) {
        if (const FrontierEntry e{gain_m(c), 0, c}; first.candidate < 0 || first < e) first = e;
    }
    queue.push(first);
    Chosen out;
    while (!queue.empty()) {
        FrontierEntry top = queue.top();
        queue.pop();
        if (waiting[idx(top.candidate)] == 0) continue;
        if (const double now = gain_m(top.candidate); now != top.gain_m) {
            top.gain_m = now;
            queue.push(top);
            continue;
        }
        waiting[idx(top.candidate)] = 0;
        out.push_back(top.candidate);
        for (const std::int32_t p : in.rows.row(top.candidate)) {
            if (covered[idx(p)] == 0) fresh.insert(p);
        }
        in.graph.each(top.candidate, [&](std::int32_t n, double overlap) {
            if (waiting[idx(n)] != 0) queue.push({gain_m(n), overlap, n});
        });
    }
    return out;
}

}  // namespace vfplan
