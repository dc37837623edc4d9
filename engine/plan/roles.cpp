#include "engine/plan/roles.h"

#include <algorithm>
#include <vector>

#include "engine/graphs/cuts.h"
#include "engine/plan/plan_graph.h"
#include "kernels/index.h"

namespace vfplan {

void add_roles(const PlanInput& in, Plan& plan) {
    // Of each piece the only station that covers it; -1: none yet, -2: several.
    std::vector<std::int32_t> only(in.piece_length_m.size(), -1);
    for (std::size_t s = 0; s < plan.stations.size(); ++s) {
        for (const std::int32_t p : in.rows.row(plan.stations[s].candidate)) {
            only[idx(p)] = only[idx(p)] == -1 ? static_cast<std::int32_t>(s) : -2;
        }
    }
    for (std::size_t p = 0; p < only.size(); ++p) {
        if (only[p] >= 0) plan.stations[idx(only[p])].only_length_m += in.piece_length_m[p];
    }
    const Cuts cuts = find_cuts(graph_of(plan));
    for (std::size_t s = 0; s < plan.stations.size(); ++s) {
        plan.stations[s].articulation = cuts.articulation[s] != 0;
    }
    for (const Link& l : plan.links) {
        if (cuts.block[idx(l.from)] == cuts.block[idx(l.to)]) continue;
        plan.stations[idx(l.from)].bridge_end = true;
        plan.stations[idx(l.to)].bridge_end = true;
    }
    for (const Link& l : strongest_tree(plan)) {  // the strongest first
        plan.stations[idx(l.from)].needed_overlap = l.overlap;
        plan.stations[idx(l.to)].needed_overlap = l.overlap;
    }
}

}  // namespace vfplan
