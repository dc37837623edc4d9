#include "engine/plan/plan.h"

#include <algorithm>
#include <numeric>

#include "engine/graphs/cuts.h"
#include "engine/graphs/shortcuts.h"
#include "engine/plan/certify.h"
#include "engine/plan/greedy.h"
#include "engine/plan/loops.h"
#include "engine/plan/order.h"
#include "engine/plan/refine.h"
#include "engine/search/spacing.h"
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
        if (idx(number[idx(c)]) >= members.size()) members.emplace_back();
        members[idx(number[idx(c)])].push_back(c);
    }
    std::vector<double> length(members.size(), 0);
    std::vector<std::int32_t> last(in.piece_length_m.size(), -1);
    for (std::size_t m = 0; m < members.size(); ++m) {
        for (const std::int32_t c : members[m]) {
            for (const std::int32_t p : in.rows.row(c)) {
                if (last[idx(p)] == static_cast<std::int32_t>(m)) continue;
                last[idx(p)] = static_cast<std::int32_t>(m);
                length[m] += in.piece_length_m[idx(p)];
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

// Stations on no cycle, in networks of more than one.
std::int64_t stations_off_cycle(const PlanInput& in, const std::vector<Network>& networks,
                                Chosen Network::*plan) {
    std::vector<std::int32_t> all;
    for (const Network& n : networks) {
        const Chosen& stations = n.*plan;
        if (stations.size() > 1) all.insert(all.end(), stations.begin(), stations.end());
    }
    std::sort(all.begin(), all.end());
    const Cuts cuts = find_cuts(induced(in.graph, all));
    return std::count(cuts.on_cycle.begin(), cuts.on_cycle.end(), 0);
}

std::int64_t stations_too_near(const PlanInput& in, const Plan& plan, double spacing_m) {
    std::vector<Vec2d> at;
    for (const Station& s : plan.stations) at.push_back(in.candidates[idx(s.candidate)].at);
    const Sparse near = nearer_than(at, spacing_m);
    std::int64_t count = 0;
    for (std::int32_t i = 0; i < near.size(); ++i) count += near.of(i).empty() ? 0 : 1;
    return count;
}

SurvivalReport pieces_alone(const PlanInput& in, const std::vector<std::int32_t>& owner,
                            const std::vector<Network>& networks) {
    std::vector<std::uint8_t> seen(owner.size(), 0);  // by so many candidates, as far as 2
    for (std::size_t n = 0; n < networks.size(); ++n) {
        for (const std::int32_t c : networks[n].members) {
            for (const std::int32_t p : in.rows.row(c)) {
                if (owner[idx(p)] != static_cast<std::int32_t>(n) || seen[idx(p)] == 2) continue;
                ++seen[idx(p)];
            }
        }
    }
    SurvivalReport out;
    for (std::size_t p = 0; p < seen.size(); ++p) {
        if (seen[p] != 1) continue;
        ++out.pieces_alone;
        out.length_alone_m += in.piece_length_m[p];
    }
    return out;
}

// Stations for shorter ways, in each network by itself; returns how many.
std::int64_t add_shortcuts(const Threads& threads, const PlanInput& in, double share,
                           std::vector<Network>& networks) {
    if (share <= 0) return 0;
    std::vector<Chosen> more(networks.size());
    threads.for_each(static_cast<std::int64_t>(networks.size()), 1,
                     [&](std::int64_t from, std::int64_t to) {
                         for (std::int64_t n = from; n < to; ++n) {
                             const Network& network = networks[idx(n)];
                             const auto stations = static_cast<double>(network.chosen.size());
                             for (const std::int32_t c :
                                  shortcuts(induced(in.graph, network.members),
                                            columns_of(network.members, network.chosen),
                                            static_cast<std::int64_t>(share * stations))) {
                                 more[idx(n)].push_back(network.members[idx(c)]);
                             }
                         }
                     });
    std::int64_t count = 0;
    for (std::size_t n = 0; n < networks.size(); ++n) {
        Chosen& chosen = networks[n].chosen;
        chosen.insert(chosen.end(), more[n].begin(), more[n].end());
        count += static_cast<std::int64_t>(more[n].size());
    }
    return count;
}

// `searched`: not in the order of choice.
void add_stations(const PlanInput& in, const std::vector<Network>& networks, bool searched,
                  Workspace& work, Plan& plan) {
    std::vector<std::uint8_t> covered(in.piece_length_m.size(), 0);
    for (std::size_t network = 0; network < networks.size(); ++network) {
        const Chosen& chosen = networks[network].chosen;
        for (const std::int32_t c : searched ? in_order(in, chosen, covered, work) : chosen) {
            Station station;
            station.candidate = c;
            station.network = static_cast<std::int32_t>(network);
            station.order = static_cast<std::int32_t>(plan.stations.size());
            for (const std::int32_t p : in.rows.row(c)) {
                const double length = in.piece_length_m[idx(p)];
                station.seen_length_m += length;
                if (covered[idx(p)] == 0) station.new_length_m += length;
                covered[idx(p)] = 1;
                if (network == 0) plan.pieces[idx(p)] = PieceStatus::covered;
            }
            plan.stations.push_back(station);
        }
    }
}

void add_links(const PlanInput& in, Plan& plan) {
    std::vector<std::int32_t> station_of(idx(in.graph.size()), -1);
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        station_of[idx(plan.stations[i].candidate)] = static_cast<std::int32_t>(i);
    }
    for (std::size_t i = 0; i < plan.stations.size(); ++i) {
        const std::int32_t c = plan.stations[i].candidate;
        std::vector<Link> links;
        in.graph.each(c, [&](std::int32_t n, double overlap_value) {
            const std::int32_t other = station_of[idx(n)];
            if (other <= static_cast<std::int32_t>(i)) return;
            links.push_back({static_cast<std::int32_t>(i), other, overlap_value, {}});
        });
        std::sort(links.begin(), links.end(),
                  [](const Link& p, const Link& q) { return p.to < q.to; });
        plan.links.insert(plan.links.end(), links.begin(), links.end());
    }
}

}  // namespace

Plan make_plan(const Threads& threads, const PlanInput& in, const PlanOptions& options,
               PlanReport& report, Progress* progress) {
    report = {};
    Plan plan;
    std::vector<std::vector<std::int32_t>> components = ranked_components(in);
    // Points off the ridges that overlap with none on them make no network of their own: what they
    // cover is covered without. Of all candidates they come last.
    std::erase_if(components, [&](const std::vector<std::int32_t>& members) {
        return in.candidates[idx(members.front())].kind == CandidateKind::pool;
    });
    plan.pieces = in.status;
    std::vector<std::uint8_t> wanted(in.status.size());
    for (const std::vector<std::int32_t>& members : components) {
        for (const std::int32_t c : members) {
            // What the tables say that no cell sees, but for rounding, the pool may see after all.
            for (const std::int32_t p : in.rows.row(c)) wanted[idx(p)] = 1;
        }
    }
    for (std::size_t p = 0; p < wanted.size(); ++p) {
        if (wanted[p] != 0) plan.pieces[p] = PieceStatus::unreached;
    }
    Workspace work(in.graph);
    std::vector<Network> networks;
    std::vector<std::uint8_t> fixed(idx(in.graph.size()), 0);
    std::vector<std::int32_t> owner(in.piece_length_m.size(), -1);
    for (std::vector<std::int32_t>& members : components) {
        std::vector<std::int32_t> forced;
        bool adds = false;
        const auto number = static_cast<std::int32_t>(networks.size());
        for (const std::int32_t c : members) {
            if (is_forced(in.candidates[idx(c)])) {
                forced.push_back(c);
                fixed[idx(c)] = 1;
            }
            for (const std::int32_t p : in.rows.row(c)) {
                if (wanted[idx(p)] == 0) continue;
                owner[idx(p)] = number;
                adds = true;
            }
        }
        if (!adds && forced.empty()) continue;
        Chosen chosen = choose_greedily(in, members, forced, wanted, work);
        networks.push_back({std::move(members), std::move(chosen), {}});
        report.greedy_stations += static_cast<std::int64_t>(networks.back().chosen.size());
    }
    if (options.method == PlanMethod::greedy) {
        for (Network& n : networks) {
            n.connected = n.chosen;
            if (options.loops) n.chosen = close_loops(in, n.chosen, work);
        }
    } else {
        plan.certificate = refine(threads, in, options, owner, fixed, networks, progress);
    }
    if (options.method != PlanMethod::refined) {
        plan.certificate = certify(threads, in, options, owner, fixed, networks);
    }
    for (const Network& n : networks) {
        report.connected += static_cast<std::int64_t>(n.connected.size());
    }
    if (options.survive) {
        report.survival = pieces_alone(in, owner, networks);
        report.survival->stations = make_surviving(threads, in, options, owner, fixed, networks);
    }
    report.shortcuts = add_shortcuts(threads, in, options.shortcuts, networks);
    report.off_cycle_before = stations_off_cycle(in, networks, &Network::connected);
    report.off_cycle_after = stations_off_cycle(in, networks, &Network::chosen);
    add_stations(in, networks, options.method != PlanMethod::greedy || options.survive, work, plan);
    add_links(in, plan);
    report.too_near = stations_too_near(in, plan, options.min_spacing_m);
    return plan;
}

}  // namespace vfplan
