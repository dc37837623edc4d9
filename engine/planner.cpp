#include "engine/planner.h"

#include <algorithm>
#include <numeric>

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
    std::vector<std::int32_t> last(in.piece_length_m.size(), -1);
    for (std::size_t m = 0; m < members.size(); ++m) {
        for (const std::int32_t c : members[m]) {
            for (const std::int32_t p : in.rows.row(c)) {
                if (last[at(p)] == static_cast<std::int32_t>(m)) continue;
                last[at(p)] = static_cast<std::int32_t>(m);
                length[m] += in.piece_length_m[at(p)];
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
        for (const std::int32_t p : in.rows.row(c)) ++count[at(p)];
    }
}

// Stations on no cycle, in networks of more than one.
std::int64_t loose_stations(const PlanInput& in, const std::vector<Chosen>& networks) {
    std::vector<std::int32_t> all;
    for (const Chosen& chosen : networks) {
        if (chosen.size() > 1) all.insert(all.end(), chosen.begin(), chosen.end());
    }
    std::sort(all.begin(), all.end());
    const Cuts cuts = find_cuts(induced(in.graph, all));
    return std::count(cuts.on_cycle.begin(), cuts.on_cycle.end(), 0);
}

void add_stations(const PlanInput& in, const std::vector<Chosen>& networks, Plan& plan) {
    std::vector<std::uint8_t> covered(in.piece_length_m.size(), 0);
    for (std::size_t network = 0; network < networks.size(); ++network) {
        for (const std::int32_t c : networks[network]) {
            Station station;
            station.candidate = c;
            station.network = static_cast<std::int32_t>(network);
            station.order = static_cast<std::int32_t>(plan.stations.size());
            for (const std::int32_t p : in.rows.row(c)) {
                const double length = in.piece_length_m[at(p)];
                station.seen_length_m += length;
                if (covered[at(p)] == 0) station.new_length_m += length;
                covered[at(p)] = 1;
                if (network == 0) plan.pieces[at(p)] = PieceStatus::covered;
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
            links.push_back({static_cast<std::int32_t>(i), other, overlap_value, {}});
        });
        std::sort(links.begin(), links.end(),
                  [](const Link& p, const Link& q) { return p.to < q.to; });
        plan.links.insert(plan.links.end(), links.begin(), links.end());
    }
}

}  // namespace

Workspace::Workspace(const Graph& graph)
    : mark(at(graph.size()), 0),
      overlap(mark.size(), 0),
      step(mark.size(), 0),
      hops(mark.size(), far_away),
      before(mark.size(), -1),
      chosen(graph),
      stations(graph) {}

Plan make_plan(const PlanInput& in, const PlanOptions& options, PlanReport& report) {
    report = {};
    Plan plan;
    plan.pieces = in.reach;
    std::vector<std::uint8_t> wanted(in.reach.size());
    for (std::size_t p = 0; p < wanted.size(); ++p) {
        wanted[p] = in.reach[p] == PieceStatus::covered ? 1 : 0;
        if (wanted[p] != 0) plan.pieces[p] = PieceStatus::unreached;
    }
    Workspace work(in.graph);
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
            for (const std::int32_t p : in.rows.row(c)) adds = adds || wanted[at(p)] != 0;
        }
        if (!adds && forced.empty()) continue;
        networks.push_back(greedy_network(in, members, forced, wanted, work));
        report.greedy_stations += static_cast<std::int64_t>(networks.back().size());
    }
    if (options.method != "greedy") {
        std::vector<std::int32_t> count(in.piece_length_m.size(), 0);
        for (Chosen& chosen : networks) {
            // With the networks before it, so that the main one never leans on a lesser one.
            count_coverage(in, chosen, count);
            const std::size_t before = chosen.size();
            chosen = prune_network(in, chosen, kept, count, work);
            report.pruned_stations += static_cast<std::int64_t>(before - chosen.size());
        }
    }
    report.loose_before = report.loose_after = loose_stations(in, networks);
    for (const Chosen& chosen : networks) {
        report.before_loops += static_cast<std::int64_t>(chosen.size());
    }
    if (options.loops) {
        for (Chosen& chosen : networks) chosen = close_loops(in, chosen, work);
        report.loose_after = loose_stations(in, networks);
    }
    add_stations(in, networks, plan);
    add_links(in, plan);
    return plan;
}

namespace {

// Angles of rows asked for in ascending order, fetched many rows at a time.
class AngleWindow {
public:
    AngleWindow(const PieceRows& rows, const AngleSource& source) : rows_(rows), source_(source) {}

    std::span<const float> of(std::int32_t c) {
        const std::int64_t from = rows_.begin[at(c)];
        const std::int64_t to = rows_.begin[at(c) + 1];
        if (to > from_ + static_cast<std::int64_t>(angles_.size())) {
            // Whole rows, so that none is fetched twice; one at least, however long.
            const auto next = rows_.begin.begin() + c + 1;
            const auto end = std::upper_bound(next + 1, rows_.begin.end(), from + most) - 1;
            from_ = from;
            angles_ = {};
            angles_ = source_(from, *end - from);
        }
        return {angles_.data() + (from - from_), angles_.data() + (to - from_)};
    }

private:
    static constexpr std::int64_t most = std::int64_t{1} << 22;  // 16 MB
    const PieceRows& rows_;
    const AngleSource& source_;
    std::int64_t from_ = 0;
    std::vector<float> angles_;
};

// Sums over the pieces that two rows share: their length, and their angle from the first.
void add_shared(std::span<const std::int32_t> a, std::span<const float> angles_a,
                std::span<const std::int32_t> b, const std::vector<double>& piece_length_m,
                double& length_m, double& angle_rad) {
    for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
        if (a[i] < b[k]) {
            ++i;
        } else if (b[k] < a[i]) {
            ++k;
        } else {
            length_m += piece_length_m[at(a[i])];
            angle_rad += static_cast<double>(angles_a[i]);
            ++i;
            ++k;
        }
    }
}

}  // namespace

void add_ratios(const PlanInput& in, const AngleSource& angles, Plan& plan) {
    // What two rows share, as seen from one end, needs that end's angles and both rows' pieces:
    // each candidate has its turn by itself.
    struct End {
        std::int32_t station;
        std::int32_t other;
        std::size_t link;
    };
    const auto row_of = [&](std::int32_t station) { return plan.stations[at(station)].candidate; };
    std::vector<End> ends;
    ends.reserve(2 * plan.links.size());
    for (std::size_t i = 0; i < plan.links.size(); ++i) {
        ends.push_back({plan.links[i].from, plan.links[i].to, i});
        ends.push_back({plan.links[i].to, plan.links[i].from, i});
    }
    std::sort(ends.begin(), ends.end(), [&](const End& a, const End& b) {
        return std::pair(row_of(a.station), a.link) < std::pair(row_of(b.station), b.link);
    });
    std::vector<SeenTotal> totals(plan.stations.size());
    std::vector<SeenJointly> joint(plan.links.size());
    AngleWindow window(in.rows, angles);
    std::int32_t last = -1;
    for (const End& e : ends) {
        const std::int32_t c = row_of(e.station);
        const std::span<const std::int32_t> row = in.rows.row(c);
        const std::span<const float> angle = window.of(c);
        if (e.station != last) {
            SeenTotal& total = totals[at(e.station)];
            for (const std::int32_t p : row) total.length_m += in.piece_length_m[at(p)];
            for (const float a : angle) total.angle_rad += static_cast<double>(a);
            last = e.station;
        }
        SeenJointly& sum = joint[e.link];
        const bool first = e.station == plan.links[e.link].from;
        double same = 0;  // the other end has the same length
        add_shared(row, angle, in.rows.row(row_of(e.other)), in.piece_length_m,
                   first ? sum.length_m : same, first ? sum.angle_a_rad : sum.angle_b_rad);
    }
    for (std::size_t i = 0; i < plan.links.size(); ++i) {
        Link& link = plan.links[i];
        for (std::size_t r = 0; r < link.ratios.size(); ++r) {
            link.ratios[r] = overlap(static_cast<OverlapRatio>(r), totals[at(link.from)],
                                     totals[at(link.to)], joint[i]);
        }
    }
}

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
        return found != nodes_.end() && lesser_part_[at(found - nodes_.begin())] > gone_;
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

Chosen prune_network(const PlanInput& in, const Chosen& chosen,
                     const std::vector<std::uint8_t>& kept, std::vector<std::int32_t>& count,
                     Workspace& work) {
    Separation& network = work.chosen;
    for (const std::int32_t v : chosen) network.add(v);
    SureCuts sure(in.graph, network, chosen);
    std::size_t left = chosen.size();
    for (auto v = chosen.rbegin(); v != chosen.rend() && left > 1; ++v) {
        const std::span<const std::int32_t> row = in.rows.row(*v);
        if (kept[at(*v)] != 0 ||
            std::any_of(row.begin(), row.end(), [&](std::int32_t p) { return count[at(p)] < 2; })) {
            continue;
        }
        sure.renew();
        if (sure.cuts(*v) || !network.can_go(*v)) continue;
        for (const std::int32_t p : row) --count[at(p)];
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
                                         const Cycles& network) {
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

std::vector<std::int32_t> independent_pieces(const PieceRows& rows, const PieceIndex& index) {
    const auto viewers = [&](std::int32_t p) { return index.rows_of(p).size(); };
    // Fewest viewers first, then by number: counted, not sorted.
    std::vector<std::int64_t> begin(at(rows.size()) + 2, 0);
    for (std::int32_t p = 0; p < index.pieces(); ++p) ++begin[viewers(p) + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::int32_t> order(at(index.pieces()));
    for (std::int32_t p = 0; p < index.pieces(); ++p) order[at(begin[viewers(p)]++)] = p;
    std::vector<std::uint8_t> used(at(rows.size()), 0);
    std::vector<std::int32_t> out;
    for (const std::int32_t p : order) {
        const std::span<const std::int32_t> by = index.rows_of(p);
        if (by.empty() ||
            std::any_of(by.begin(), by.end(), [&](std::int32_t c) { return used[at(c)] != 0; })) {
            continue;
        }
        for (const std::int32_t c : by) used[at(c)] = 1;
        out.push_back(p);
    }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace vfplan
