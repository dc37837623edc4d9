#include "engine/plan/loops.h"

#include <algorithm>

#include "kernels/index.h"

namespace vfplan {
namespace {

// Looks for the fewest candidates that put a station on a cycle through another one.
class LoopSearch {
public:
    LoopSearch(const PlanInput& in, Workspace& work)
        : in_(in), before_(work.before), width_(work.step), seen_(work.mark) {}

    // Breadth first from v through candidates that are not stations, to the first one that touches
    // another station; among those of one level the widest path (its smallest overlap), then the
    // lowest id. Returns it from its far end to v, without v; empty where there is none.
    std::vector<std::int32_t> from(std::int32_t v, const Cycles& network) {
        std::vector<std::int32_t> level = {v};
        std::vector<std::int32_t> path;
        width_[idx(v)] = 1;
        touched_ = {v};
        std::int32_t goal = -1;
        while (goal < 0 && !level.empty()) {
            std::vector<std::int32_t> next = next_level(level, network);
            double best = 0;
            for (const std::int32_t n : next) {
                seen_[idx(n)] = 1;
                double closing = 0;
                in_.graph.each(n, [&](std::int32_t s, double overlap_value) {
                    if (s != v && network.inside(s)) closing = std::max(closing, overlap_value);
                });
                const double w = std::min(closing, width_[idx(n)]);
                if (w > best) {
                    best = w;
                    goal = n;
                }
            }
            level = std::move(next);
        }
        for (std::int32_t c = goal; c >= 0 && c != v; c = before_[idx(c)]) path.push_back(c);
        for (const std::int32_t c : touched_) {
            before_[idx(c)] = -1;
            width_[idx(c)] = 0;
            seen_[idx(c)] = 0;
        }
        return path;
    }

private:
    std::vector<std::int32_t> next_level(const std::vector<std::int32_t>& level,
                                         const Cycles& network) {
        std::vector<std::int32_t> next;
        for (const std::int32_t c : level) {
            in_.graph.each(c, [&](std::int32_t n, double overlap_value) {
                if (seen_[idx(n)] == 1 || network.inside(n)) return;
                if (seen_[idx(n)] == 0) {
                    seen_[idx(n)] = 2;
                    next.push_back(n);
                    touched_.push_back(n);
                }
                const double w = std::min(width_[idx(c)], overlap_value);
                if (w > width_[idx(n)]) {
                    width_[idx(n)] = w;
                    before_[idx(n)] = c;
                }
            });
        }
        std::sort(next.begin(), next.end());
        return next;
    }

    const PlanInput& in_;
    std::vector<std::int32_t>& before_;
    std::vector<double>& width_;
    std::vector<std::uint8_t>& seen_;
    std::vector<std::int32_t> touched_;
};

}  // namespace

Chosen close_loops(const PlanInput& in, const Chosen& chosen, Workspace& work) {
    Chosen out = chosen;
    if (out.size() < 2) return out;
    work.stations.add_network(chosen);
    LoopSearch search(in, work);
    for (const std::int32_t v : chosen) {
        if (work.stations.on_cycle(v)) continue;
        for (const std::int32_t c : search.from(v, work.stations)) {
            work.stations.add(c);
            out.push_back(c);
        }
    }
    return out;
}

}  // namespace vfplan
