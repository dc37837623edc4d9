#include "engine/plan/plan_graph.h"

#include <algorithm>

#include "kernels/disjoint_sets.h"

namespace vfplan {

Graph graph_of(const Plan& plan) {
    std::vector<OverlapPair> pairs;
    for (const Link& l : plan.links) pairs.push_back({l.from, l.to, l.overlap});
    return make_graph(static_cast<std::int32_t>(plan.stations.size()), pairs);
}

std::vector<Link> strongest_tree(const Plan& plan) {
    DisjointSets sets(static_cast<std::int64_t>(plan.stations.size()));
    std::vector<Link> links = plan.links;
    std::stable_sort(links.begin(), links.end(),
                     [](const Link& a, const Link& b) { return a.overlap > b.overlap; });
    std::erase_if(links, [&](const Link& l) {
        if (sets.together(l.from, l.to)) return true;
        sets.merge(l.from, l.to);
        return false;
    });
    return links;
}

}  // namespace vfplan
