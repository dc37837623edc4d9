#include "engine/joining.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace vfplan {
namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

// Sets of candidates that merge.
class Sets {
public:
    explicit Sets(std::int32_t n) : parent_(at(n)) { std::iota(parent_.begin(), parent_.end(), 0); }
    std::int32_t root(std::int32_t v) {
        while (parent_[at(v)] != v) v = parent_[at(v)] = parent_[at(parent_[at(v)])];
        return v;
    }
    void merge(std::int32_t a, std::int32_t b) { parent_[at(root(a))] = root(b); }

private:
    std::vector<std::int32_t> parent_;
};

}  // namespace

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
    Sets sets(any.size());
    std::size_t open = first.size() - 1;
    for (const OverlapPair& p : pairs) {
        if (open == 0) break;
        if (sets.root(p.from) == sets.root(p.to)) continue;
        sets.merge(p.from, p.to);
        for (std::size_t n = 1; n < first.size(); ++n) {
            if (out.joins_at[n] > 0 || sets.root(first[n]) != sets.root(first[0])) continue;
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
