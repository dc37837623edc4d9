#include "engine/joining.h"

#include <algorithm>
#include <set>

#include "engine/disjoint_sets.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// The rows' pieces that are seen from more than one component, and nothing else: what candidates
// of different components share is in there, whole and in order.
PieceRows shared_between(const PieceRows& rows, const std::vector<std::int32_t>& part,
                         std::size_t pieces) {
    constexpr std::int32_t nobody = -1;
    constexpr std::int32_t several = -2;
    std::vector<std::int32_t> seen_from(pieces, nobody);
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        for (const std::int32_t p : rows.row(c)) {
            std::int32_t& from = seen_from[at(p)];
            if (from == nobody) from = part[at(c)];
            if (from != part[at(c)]) from = several;
        }
    }
    const bool angles = !rows.angle_rad.empty();
    PieceRows out;
    out.begin.reserve(rows.begin.size());
    for (std::int32_t c = 0; c < rows.size(); ++c) {
        const std::span<const std::int32_t> row = rows.row(c);
        for (std::size_t i = 0; i < row.size(); ++i) {
            if (seen_from[at(row[i])] != several) continue;
            out.piece.push_back(row[i]);
            if (angles) out.angle_rad.push_back(rows.angles(c)[i]);
        }
        out.begin.push_back(static_cast<std::int64_t>(out.piece.size()));
    }
    return out;
}

// Two parts and the most that a candidate of one overlaps with a candidate of the other.
struct Neighbours {
    std::int32_t a = 0;
    std::int32_t b = 0;
    double overlap = 0;
};

// Merges parts by descending overlap until each network has met the main one; gives the overlap
// at which it did, 0 where it never does. network_of: by part, -1 for a part without.
std::vector<double> joins_at(std::vector<Neighbours> pairs,
                             const std::vector<std::int32_t>& network_of, std::size_t networks) {
    std::stable_sort(pairs.begin(), pairs.end(), [](const Neighbours& p, const Neighbours& q) {
        return p.overlap > q.overlap;
    });
    DisjointSets sets(static_cast<std::int64_t>(network_of.size()));
    // Networks of each set that have not met the main one, by the set's root.
    std::vector<std::vector<std::int32_t>> waiting(network_of.size());
    for (std::size_t part = 0; part < network_of.size(); ++part) {
        if (network_of[part] >= 0) waiting[part].push_back(network_of[part]);
    }
    const auto main_part = static_cast<std::int32_t>(
        std::find(network_of.begin(), network_of.end(), 0) - network_of.begin());
    std::vector<double> out(networks, 0);
    out[0] = 1;
    waiting[at(main_part)].clear();
    for (const Neighbours& n : pairs) {
        const std::int32_t a = sets.root(n.a);
        const std::int32_t b = sets.root(n.b);
        if (a == b) continue;
        const std::int32_t main = sets.root(main_part);
        sets.merge(a, b);
        std::vector<std::int32_t>& left = waiting[at(sets.root(a))];
        std::vector<std::int32_t>& other = waiting[at(sets.root(a) == a ? b : a)];
        if (a == main || b == main) {
            for (const std::int32_t network : left) out[at(network)] = n.overlap;
            for (const std::int32_t network : other) out[at(network)] = n.overlap;
            left.clear();
        } else {
            if (left.size() < other.size()) left.swap(other);
            left.insert(left.end(), other.begin(), other.end());
        }
        other = {};
    }
    return out;
}

}  // namespace

Joining find_joining(const Threads& threads, const PlanInput& in, const PlanOptions& options,
                     const Plan& plan) {
    std::size_t networks = 0;
    for (const Station& s : plan.stations) networks = std::max(networks, at(s.network) + 1);
    Joining out;
    out.joins_at.assign(networks, 1);
    out.networks_by_min_len = static_cast<std::int64_t>(networks);
    if (networks < 2) return out;

    const std::vector<std::int32_t> part = components(in.graph);
    const std::size_t parts = at(*std::max_element(part.begin(), part.end())) + 1;
    std::vector<std::int32_t> network_of(parts, -1);
    for (const Station& s : plan.stations) network_of[at(part[at(s.candidate)])] = s.network;

    DisjointSets by_min_len(static_cast<std::int64_t>(parts));
    std::vector<Neighbours> best;
    {
        const std::vector<SeenTotal> totals = seen_totals(in.rows, in.piece_length_m);
        const PieceRows between = shared_between(in.rows, part, in.piece_length_m.size());
        const PieceIndex index =
            index_of(between, static_cast<std::int64_t>(in.piece_length_m.size()));
        SharedLengths shared;
        std::vector<Neighbours> found;
        for (std::int32_t c = 0; c < between.size(); ++c) {
            for (const std::int32_t p : between.row(c)) {
                const std::span<const std::int32_t> viewers = index.rows_of(p);
                for (auto n = std::upper_bound(viewers.begin(), viewers.end(), c);
                     n != viewers.end(); ++n) {
                    if (part[at(*n)] != part[at(c)]) shared.add(*n, in.piece_length_m[at(p)]);
                }
            }
            shared.take([&](std::int32_t n, double length_m) {
                SeenJointly joint{length_m, 0, 0};
                if (overlap(OverlapRatio::min_len, totals[at(c)], totals[at(n)], joint) >=
                    options.threshold) {
                    by_min_len.merge(part[at(c)], part[at(n)]);
                }
                if (by_angle(options.ratio)) {
                    joint = seen_jointly(between, in.piece_length_m, c, n);
                }
                const double o = overlap(options.ratio, totals[at(c)], totals[at(n)], joint);
                const auto [a, b] = std::minmax(part[at(c)], part[at(n)]);
                if (o > 0) found.push_back({a, b, o});
            });
            // The best of each pair of parts, now and then.
            if (found.size() < 2 * best.size() + 4096 && c + 1 < between.size()) continue;
            found.insert(found.end(), best.begin(), best.end());
            std::sort(found.begin(), found.end(), [](const Neighbours& p, const Neighbours& q) {
                return std::tuple(p.a, p.b, -p.overlap) < std::tuple(q.a, q.b, -q.overlap);
            });
            found.erase(std::unique(found.begin(), found.end(),
                                    [](const Neighbours& p, const Neighbours& q) {
                                        return p.a == q.a && p.b == q.b;
                                    }),
                        found.end());
            best.swap(found);
            found.clear();
        }
    }
    out.joins_at = joins_at(std::move(best), network_of, networks);

    // By lengths, whatever overlaps enough by the job's ratio does so by min_len: only what lies
    // between the parts can join them. Angles say nothing of lengths.
    std::set<std::int32_t> joined;
    if (!by_angle(options.ratio)) {
        for (const Station& s : plan.stations) {
            joined.insert(by_min_len.root(part[at(s.candidate)]));
        }
    } else {
        const PieceIndex index =
            index_of(in.rows, static_cast<std::int64_t>(in.piece_length_m.size()));
        const std::vector<std::int32_t> all = components(make_graph(overlap_pairs(
            threads, in.rows, index, in.piece_length_m, OverlapRatio::min_len, options.threshold)));
        for (const Station& s : plan.stations) joined.insert(all[at(s.candidate)]);
    }
    out.networks_by_min_len = static_cast<std::int64_t>(joined.size());
    return out;
}

}  // namespace vfplan
