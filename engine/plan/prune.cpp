#include "engine/plan/prune.h"

#include <algorithm>
#include <span>

#include "engine/graphs/cuts.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Nodes that certainly cut a network, which shrinks: those of which both sides had more nodes than
// have gone since. Looking around such a node would cost as much as its lesser side holds, which in
// a large network is much; this list costs about as much as the looking around that it follows.
class SureCuts {
public:
    SureCuts(const Graph& graph, const Separation& network, const Chosen& chosen)
        : graph_(graph), network_(network), chosen_(chosen) {}

    bool cuts(std::int32_t v) const {
        const auto found = std::lower_bound(nodes_.begin(), nodes_.end(), v);
        return found != nodes_.end() && lesser_part_[idx(found - nodes_.begin())] > gone_;
    }
    // To be told of each node that goes.
    void one_gone() { ++gone_; }
    void renew() {
        if (network_.steps() - steps_ <
            static_cast<std::int64_t>(chosen_.size()) + graph_.size() / 64) {
            return;
        }
        nodes_.clear();
        for (const std::int32_t v : chosen_) {
            if (network_.inside(v)) nodes_.push_back(v);
        }
        std::sort(nodes_.begin(), nodes_.end());
        lesser_part_ = find_cuts(induced(graph_, nodes_)).lesser_part;
        gone_ = 0;
        steps_ = network_.steps();
    }

private:
    const Graph& graph_;
    const Separation& network_;
    const Chosen& chosen_;
    std::int64_t steps_ = network_.steps();
    std::int64_t gone_ = 0;
    std::vector<std::int32_t> nodes_;        // ascending, when last renewed
    std::vector<std::int32_t> lesser_part_;  // of each
};

}  // namespace

Chosen prune(const PlanInput& in, const Chosen& chosen, const std::vector<std::uint8_t>& kept,
             std::vector<std::int32_t>& count, Workspace& work) {
    Separation& network = work.chosen;
    for (const std::int32_t v : chosen) network.add(v);
    SureCuts sure(in.graph, network, chosen);
    std::size_t left = chosen.size();
    for (auto v = chosen.rbegin(); v != chosen.rend() && left > 1; ++v) {
        const std::span<const std::int32_t> row = in.rows.row(*v);
        if (kept[idx(*v)] != 0 || std::any_of(row.begin(), row.end(),
                                              [&](std::int32_t p) { return count[idx(p)] < 2; })) {
            continue;
        }
        sure.renew();
        if (sure.cuts(*v) || !network.can_go(*v)) continue;
        for (const std::int32_t p : row) --count[idx(p)];
        network.remove(*v);
        sure.one_gone();
        --left;
    }
    Chosen out;
    for (const std::int32_t v : chosen) {
        if (network.inside(v)) out.push_back(v);
    }
    return out;
}

}  // namespace vfplan
