#include "engine/joining.h"
#include "engine/disjoint_sets.h"
#include "kernels/index.h"

#include <algorithm>
#include <set>

namespace vfplan {
Joining find_joining(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                     const Plan& plan) {
    std::vector<std::int32_t> first;  // a candidate of each network
    for (const Station& s : plan.stations) {
        if (at(s.network) == first.size()) first.push_back(s.candidate);
    }
    Joining out;
    out.joins_at.assign(first.size(), 0);
    out.networks_by_min_len = static_cast<std::int64_t>(first.size());
    if (!first.empty()) out.joins_at[0] = 1;
    if (first.size() < 2) return out;

    const Graph any = overlap_graph(threads, in.pieces, in.table, options.ratio, 0);
    std::vector<OverlapPair> pairs;
    for (std::int32_t v = 0; v < any.size(); ++v) {
        any.each(v, [&](std::int32_t n, double o) {
            if (n > v) pairs.push_back({v, n, o});
        });
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const OverlapPair& a, const OverlapPair& b) {
        return a.overlap > b.overlap;
    });
    DisjointSets sets(any.size());
    std::size_t open = first.size() - 1;
    for (const OverlapPair& p : pairs) {
        if (open == 0) break;
        if (sets.together(p.from, p.to)) continue;
        sets.merge(p.from, p.to);
        for (std::size_t n = 1; n < first.size(); ++n) {
            if (out.joins_at[n] > 0 || !sets.together(first[n], first[0])) continue;
            out.joins_at[n] = p.overlap;
            --open;
        }
    }
    const std::vector<std::int32_t> part = components(
        overlap_graph(threads, in.pieces, in.table, OverlapRatio::min_len, options.threshold));
    std::set<std::int32_t> parts;
    for (const Station& s : plan.stations) parts.insert(part[at(s.candidate)]);
    out.networks_by_min_len = static_cast<std::int64_t>(parts.size());
    return out;
}

}  // namespace vfplan
