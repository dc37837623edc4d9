#include "engine/planner.h"

#include <algorithm>
#include <numeric>

#include "engine/separation.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

bool is_forced(const Candidate& c) {
    return c.kind == CandidateKind::required || c.kind == CandidateKind::existing;
}

// Components of the candidates' graph, the one that can cover most length first.
std::vector<std::vector<std::int32_t>> ranked_components(const PlanInput& in) {
    const std::vector<std::int32_t> number = components(in.graph);
    std::vector<std::vector<std::int32_t>> members;
    for (std::int32_t c = 0; c < in.graph.size(); ++c) {
        if (at(number[at(c)]) >= members.size()) members.emplace_back();
        members[at(number[at(c)])].push_back(c);
    }
    std::vector<double> length(members.size(), 0);
    std::vector<std::int32_t> last(at(in.pieces.size()), -1);
    for (std::size_t m = 0; m < members.size(); ++m) {
        for (const std::int32_t c : members[m]) {
            for (const Seen* s = in.table.row_begin(c); s != in.table.row_end(c); ++s) {
                if (last[at(s->piece)] == static_cast<std::int32_t>(m)) continue;
                last[at(s->piece)] = static_cast<std::int32_t>(m);
                length[m] += in.pieces.length_m(s->piece);
            }
        }
    }
    std::vector<std::size_t> order(members.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return length[a] > length[b]; });
    std::vector<std::vector<std::int32_t>> out;
    for (const std::size_t m : order) out.push_back(std::move(members[m]));
    return out;
}

void count_coverage(const PlanInput& in, const Chosen& chosen, std::vector<std::int32_t>& count) {
    for (const std::int32_t c : chosen) {
        for (const Seen* s = in.table.row_begin(c); s != in.table.row_end(c); ++s) {
            ++count[at(s->piece)];
        }
    }
}

std::vector<std::uint8_t> marked(const PlanInput& in, const Chosen& chosen) {
    std::vector<std::uint8_t> out(at(in.graph.size()), 0);
    for (const std::int32_t c : chosen) out[at(c)] = 1;
    return out;
}

std::int64_t loose_stations(const PlanInput& in, Chosen chosen) {
    if (chosen.size() < 2) return 0;
    std::sort(chosen.begin(), chosen.end());
    const Cuts cuts = find_cuts(induced(in.graph, chosen));
    return std::count(cuts.on_cycle.begin(), cuts.on_cycle.end(), 0);
}

void add_stations(const PlanInput& in, const std::vector<Chosen>& networks, Plan& plan) {
    std::vector<std::uint8_t> covered(at(in.pieces.size()), 0);
    for (std::size_t network = 0; network < networks.size(); ++network) {
        for (const std::int32_t c : networks[network]) {
            Station station;
            station.candidate = c;
            station.network = static_cast<std::int32_t>(network);
            station.order = static_cast<std::int32_t>(plan.stations.size());
            for (const Seen* s = in.table.row_begin(c); s != in.table.row_end(c); ++s) {
                const double length = in.pieces.length_m(s->piece);
                station.seen_length_m += length;
                if (covered[at(s->piece)] == 0) station.new_length_m += length;
                covered[at(s->piece)] = 1;
                if (network == 0) plan.pieces[at(s->piece)] = PieceStatus::covered;
            }
            plan.stations.push_back(station);
        }
    }
}

void add_links(const PlanInput& in, Plan& plan) {
    std::vector<std::int32_t> station_of(at(in.graph.size()), -1);
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        station_of[at(plan.stations[i].candidate)] = static_cast<std::int32_t>(i);
    }
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const std::int32_t c = plan.stations[i].candidate;
        std::vector<Link> links;
        in.graph.each(c, [&](std::int32_t n, double overlap_value) {
            const std::int32_t other = station_of[at(n)];
            if (other <= static_cast<std::int32_t>(i)) return;
            Link link{static_cast<std::int32_t>(i), other, overlap_value, {}};
            const Seen* a = in.table.row_begin(c);
            const Seen* a_end = in.table.row_end(c);
            const Seen* b = in.table.row_begin(n);
            const Seen* b_end = in.table.row_end(n);
            const SeenJointly joint = seen_jointly(in.pieces, a, a_end, b, b_end);
            for (std::size_t r = 0; r < link.ratios.size(); ++r) {
                link.ratios[r] =
                    overlap(static_cast<OverlapRatio>(r), seen_total(in.pieces, a, a_end),
                            seen_total(in.pieces, b, b_end), joint);
            }
            links.push_back(link);
        });
        std::sort(links.begin(), links.end(),
                  [](const Link& p, const Link& q) { return p.to < q.to; });
        plan.links.insert(plan.links.end(), links.begin(), links.end());
    }
}

}  // namespace

Plan make_plan(const PlanInput& in, const PlanOptions& options, PlanReport& report) {
    report = {};
    Plan plan;
    plan.pieces = in.reach;
    std::vector<std::uint8_t> wanted(in.reach.size());
    for (std::size_t p = 0; p < wanted.size(); ++p) {
        wanted[p] = in.reach[p] == PieceStatus::covered ? 1 : 0;
        if (wanted[p] != 0) plan.pieces[p] = PieceStatus::unreached;
    }
    std::vector<Chosen> networks;
    std::vector<std::uint8_t> kept(at(in.graph.size()), 0);
    for (const std::vector<std::int32_t>& members : ranked_components(in)) {
        std::vector<std::int32_t> forced;
        bool adds = false;
        for (const std::int32_t c : members) {
            if (is_forced(in.candidates[at(c)])) {
                forced.push_back(c);
                kept[at(c)] = 1;
            }
            for (const Seen* s = in.table.row_begin(c); s != in.table.row_end(c); ++s) {
                adds = adds || wanted[at(s->piece)] != 0;
            }
        }
        if (!adds && forced.empty()) continue;
        networks.push_back(greedy_network(in, members, forced, wanted));
        report.greedy_stations += static_cast<std::int64_t>(networks.back().size());
    }
    if (options.method != "greedy") {
        std::vector<std::int32_t> count(at(in.pieces.size()), 0);
        for (Chosen& chosen : networks) {
            // With the networks before it, so that the main one never leans on a lesser one.
            count_coverage(in, chosen, count);
            const std::size_t before = chosen.size();
            chosen = prune_network(in, chosen, kept, count);
            report.pruned_stations += static_cast<std::int64_t>(before - chosen.size());
        }
    }
    for (Chosen& chosen : networks) {
        report.before_loops += static_cast<std::int64_t>(chosen.size());
        report.loose_before += loose_stations(in, chosen);
        if (options.loops) chosen = close_loops(in, chosen);
        report.loose_after += loose_stations(in, chosen);
    }
    add_stations(in, networks, plan);
    add_links(in, plan);
    plan.bound_pieces = independent_pieces(in);
    return plan;
}

Chosen prune_network(const PlanInput& in, const Chosen& chosen,
                     const std::vector<std::uint8_t>& kept, std::vector<std::int32_t>& count) {
    Separation network(in.graph, marked(in, chosen));
    std::size_t left = chosen.size();
    for (auto v = chosen.rbegin(); v != chosen.rend() && left > 1; ++v) {
        const Seen* begin = in.table.row_begin(*v);
        const Seen* end = in.table.row_end(*v);
        if (kept[at(*v)] != 0 ||
            std::any_of(begin, end, [&](const Seen& s) { return count[at(s.piece)] < 2; }) ||
            !network.can_go(*v)) {
            continue;
        }
        for (const Seen* s = begin; s != end; ++s) --count[at(s->piece)];
        network.remove(*v);
        --left;
    }
    Chosen out;
    for (const std::int32_t v : chosen) {
        if (network.inside(v)) out.push_back(v);
    }
    return out;
}

namespace {

// Looks for the fewest candidates that put a station on a cycle through another one.
class LoopSearch {
public:
    explicit LoopSearch(const PlanInput& in)
        : in_(in),
          before_(at(in.graph.size()), -1),
          width_(before_.size(), 0),
          seen_(before_.size(), 0) {}

    // Breadth first from v through candidates that are not stations, to the first one that touches
    // another station; among those of one level the widest path (its smallest overlap), then the
    // lowest id. Returns it from its far end to v, without v; empty where there is none.
    std::vector<std::int32_t> from(std::int32_t v, const Separation& network) {
        std::vector<std::int32_t> level = {v};
        std::vector<std::int32_t> path;
        width_[at(v)] = 1;
        touched_ = {v};
        std::int32_t goal = -1;
        while (goal < 0 && !level.empty()) {
            std::vector<std::int32_t> next = next_level(level, network);
            double best = 0;
            for (const std::int32_t n : next) {
                seen_[at(n)] = 1;
                double closing = 0;
                in_.graph.each(n, [&](std::int32_t s, double overlap_value) {
                    if (s != v && network.inside(s)) closing = std::max(closing, overlap_value);
                });
                const double w = std::min(closing, width_[at(n)]);
                if (w > best) {
                    best = w;
                    goal = n;
                }
            }
            level = std::move(next);
        }
        for (std::int32_t c = goal; c >= 0 && c != v; c = before_[at(c)]) path.push_back(c);
        for (const std::int32_t c : touched_) {
            before_[at(c)] = -1;
            width_[at(c)] = 0;
            seen_[at(c)] = 0;
        }
        return path;
    }

private:
    std::vector<std::int32_t> next_level(const std::vector<std::int32_t>& level,
                                         const Separation& network) {
        std::vector<std::int32_t> next;
        for (const std::int32_t c : level) {
            in_.graph.each(c, [&](std::int32_t n, double overlap_value) {
                if (seen_[at(n)] == 1 || network.inside(n)) return;
                if (seen_[at(n)] == 0) {
                    seen_[at(n)] = 2;
                    next.push_back(n);
                    touched_.push_back(n);
                }
                const double w = std::min(width_[at(c)], overlap_value);
                if (w > width_[at(n)]) {
                    width_[at(n)] = w;
                    before_[at(n)] = c;
                }
            });
        }
        std::sort(next.begin(), next.end());
        return next;
    }

    const PlanInput& in_;
    std::vector<std::int32_t> before_;
    std::vector<double> width_;
    std::vector<std::uint8_t> seen_;
    std::vector<std::int32_t> touched_;
};

}  // namespace

Chosen close_loops(const PlanInput& in, const Chosen& chosen) {
    Chosen out = chosen;
    if (out.size() < 2) return out;
    Separation network(in.graph, marked(in, chosen));
    LoopSearch search(in);
    for (const std::int32_t v : chosen) {
        if (network.on_cycle(v)) continue;
        for (const std::int32_t c : search.from(v, network)) {
            network.add(c);
            out.push_back(c);
        }
    }
    return out;
}

std::vector<std::int32_t> independent_pieces(const PlanInput& in) {
    const InvertedIndex index = invert(in.table, in.pieces.size());
    std::vector<std::int32_t> order;
    for (std::int64_t p = 0; p < in.pieces.size(); ++p) {
        if (index.begin[at(p) + 1] > index.begin[at(p)]) {
            order.push_back(static_cast<std::int32_t>(p));
        }
    }
    const auto viewers = [&](std::int32_t p) {
        return index.begin[at(p) + 1] - index.begin[at(p)];
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::int32_t a, std::int32_t b) { return viewers(a) < viewers(b); });
    std::vector<std::uint8_t> used(at(in.table.rows()), 0);
    std::vector<std::int32_t> out;
    for (const std::int32_t p : order) {
        const auto first = index.row.begin() + index.begin[at(p)];
        const auto last = index.row.begin() + index.begin[at(p) + 1];
        if (std::any_of(first, last, [&](std::int32_t c) { return used[at(c)] != 0; })) continue;
        std::for_each(first, last, [&](std::int32_t c) { used[at(c)] = 1; });
        out.push_back(p);
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace vfplan
