#include "engine/plan/join_thresholds.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "engine/plan/overlap_graph.h"
#include "kernels/disjoint_sets.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// The rows' pieces that are seen from more than one component, and nothing else: what candidates
// of different components share is in there, whole and in order.
OverlapRows shared_between(const OverlapRows& rows, const std::vector<std::int32_t>& component,
                           std::size_t pieces) {
    constexpr std::int32_t nobody = -1;
    constexpr std::int32_t several = -2;
    std::vector<std::int32_t> seen_from(pieces, nobody);
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        for (const std::int32_t p : rows.row(c)) {
            std::int32_t& from = seen_from[idx(p)];
            if (from == nobody) from = component[idx(c)];
            if (from != component[idx(c)]) from = several;
        }
    }
    OverlapRows out;
    out.begin.reserve(rows.begin.size());
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        const SeenRow row = rows.seen(c, {});
        for (std::size_t i = 0; i < row.piece.size(); ++i) {
            if (seen_from[idx(row.piece[i])] != several) continue;
            out.piece.push_back(row.piece[i]);
            if (!row.angle_rad.empty()) out.angle_rad.push_back(row.angle_rad[i]);
        }
        out.begin.push_back(static_cast<std::int64_t>(out.piece.size()));
    }
    return out;
}

// Two components and the most that a candidate of one overlaps with a candidate of the other.
struct Neighbours {
    std::int32_t a = 0;
    std::int32_t b = 0;
    double overlap = 0;
};

// Keeps the best of each two components.
void keep_best(std::vector<Neighbours>& pairs) {
    std::sort(pairs.begin(), pairs.end(), [](const Neighbours& p, const Neighbours& q) {
        return std::tuple(p.a, p.b, -p.overlap) < std::tuple(q.a, q.b, -q.overlap);
    });
    const auto same = [](const Neighbours& p, const Neighbours& q) {
        return p.a == q.a && p.b == q.b;
    };
    pairs.erase(std::unique(pairs.begin(), pairs.end(), same), pairs.end());
}

// All pairs of components that overlap at all; and which of them min_len would join.
std::vector<Neighbours> neighbours(const PlanInput& in, const std::vector<std::int32_t>& component,
                                   const OverlapRule& rule, DisjointSets& by_min_len) {
    const std::vector<SeenTotal> totals = seen_totals(in.rows, in.piece_length_m);
    const OverlapRows between = shared_between(in.rows, component, in.piece_length_m.size());
    const PieceIndex index = index_of(between, static_cast<std::int64_t>(in.piece_length_m.size()));
    PairSearch search(between, index, in.piece_length_m, formula(rule.ratio).by_angle);
    std::vector<Neighbours> best;
    std::vector<Neighbours> found;
    for (std::int32_t c = 0; c < between.size(); ++c) {
        search.after(
            c, [&](std::int32_t n) { return component[idx(n)] != component[idx(c)]; },
            [&](std::int32_t n, const SeenJointly& joint) {
                const SeenTotal& of_c = totals[idx(c)];
                const SeenTotal& of_n = totals[idx(n)];
                if (rule.enough(overlap(OverlapRatio::min_len, of_c, of_n, joint))) {
                    by_min_len.merge(component[idx(c)], component[idx(n)]);
                }
                const double o = overlap(rule.ratio, of_c, of_n, joint);
                const auto [a, b] = std::minmax(component[idx(c)], component[idx(n)]);
                if (o > 0) found.push_back({a, b, o});
            });
        if (found.size() < 2 * best.size() + 4096) continue;  // now and then
        found.insert(found.end(), best.begin(), best.end());
        keep_best(found);
        best.swap(found);
        found.clear();
    }
    best.insert(best.end(), found.begin(), found.end());
    keep_best(best);
    return best;
}

// Merges components by descending overlap until each network has met the main one; gives the
// overlap at which it did, 0 where it never does. network_of: by component, -1 for a component
// without.
std::vector<double> joins_at(std::vector<Neighbours> pairs,
                             const std::vector<std::int32_t>& network_of, std::size_t networks) {
    std::stable_sort(pairs.begin(), pairs.end(), [](const Neighbours& p, const Neighbours& q) {
        return p.overlap > q.overlap;
    });
    DisjointSets sets(static_cast<std::int64_t>(network_of.size()));
    // Networks of each set that have not met the main one, by the set's root.
    std::vector<std::vector<std::int32_t>> waiting(network_of.size());
    for (std::size_t component = 0; component < network_of.size(); ++component) {
        if (network_of[component] >= 0) waiting[component].push_back(network_of[component]);
    }
    const auto main_component = static_cast<std::int32_t>(
        std::find(network_of.begin(), network_of.end(), 0) - network_of.begin());
    std::vector<double> out(networks, 0);
    out[0] = 1;
    waiting[idx(main_component)].clear();
    for (const Neighbours& n : pairs) {
        const std::int32_t a = sets.root(n.a);
        const std::int32_t b = sets.root(n.b);
        if (a == b) continue;
        const std::int32_t main = sets.root(main_component);
        sets.merge(a, b);
        std::vector<std::int32_t>& left = waiting[idx(sets.root(a))];
        std::vector<std::int32_t>& other = waiting[idx(sets.root(a) == a ? b : a)];
        if (a == main || b == main) {
            for (const std::int32_t network : left) out[idx(network)] = n.overlap;
            for (const std::int32_t network : other) out[idx(network)] = n.overlap;
            left.clear();
        } else {
            if (left.size() < other.size()) left.swap(other);
            left.insert(left.end(), other.begin(), other.end());
        }
        other = {};
    }
    return out;
}

// What overlaps over free cells. Components of these alone come behind the others; their names
// begin where those of the axis' candidates end.
void add_pairs(const Apart& apart, const std::vector<Candidate>& candidates,
               const std::vector<std::int32_t>& component, std::vector<std::int32_t>& network_of,
               std::vector<Neighbours>& pairs) {
    const std::size_t count = network_of.size();
    const std::size_t axis =
        idx(std::count_if(candidates.begin(), candidates.end(),
                          [](const Candidate& c) { return c.kind != CandidateKind::pool; }));
    const auto of = [&](std::int32_t name) {
        if (idx(name) < axis) return component[idx(name)];
        const std::size_t behind = count + idx(name) - axis;
        if (behind >= network_of.size()) network_of.resize(behind + 1, -1);
        return static_cast<std::int32_t>(behind);
    };
    for (const SetPair& p : apart.pairs) pairs.push_back({of(p.a), of(p.b), p.overlap});
}

}  // namespace

JoinThresholds find_join_thresholds(const Threads& threads, const PlanInput& in,
                                    const OverlapRule& rule, const Apart& apart, const Plan& plan) {
    std::size_t networks = 0;
    for (const Station& s : plan.stations) networks = std::max(networks, idx(s.network) + 1);
    JoinThresholds out;
    out.joins_at.assign(networks, 1);
    out.networks_by_min_len = static_cast<std::int64_t>(networks);
    if (networks < 2) return out;

    const std::vector<std::int32_t> component = components(in.graph);
    const auto count = idx(*std::max_element(component.begin(), component.end())) + 1;
    std::vector<std::int32_t> network_of(count, -1);
    for (const Station& s : plan.stations) network_of[idx(component[idx(s.candidate)])] = s.network;
    DisjointSets by_min_len(static_cast<std::int64_t>(count));
    std::vector<Neighbours> pairs = neighbours(in, component, rule, by_min_len);
    if (apart.rule.ratio == rule.ratio && apart.rule.threshold >= rule.threshold) {
        out.free_cells = apart.free_cells;
        add_pairs(apart, in.candidates, component, network_of, pairs);
    }
    out.joins_at = joins_at(std::move(pairs), network_of, networks);

    // By lengths, whatever overlaps enough by the job's ratio does so by min_len: only what lies
    // between the components can join them. Angles say nothing of lengths.
    std::set<std::int32_t> joined;
    if (!formula(rule.ratio).by_angle) {
        for (const Station& s : plan.stations) {
            joined.insert(by_min_len.root(component[idx(s.candidate)]));
        }
    } else {
        const std::vector<std::int32_t> all = components(make_graph(overlap_pairs(
            threads, in.rows, in.piece_length_m, {OverlapRatio::min_len, rule.threshold})));
        for (const Station& s : plan.stations) joined.insert(all[idx(s.candidate)]);
    }
    out.networks_by_min_len = static_cast<std::int64_t>(joined.size());
    return out;
}

}  // namespace vfplan
