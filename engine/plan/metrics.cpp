#include "engine/plan/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/graphs/cuts.h"
#include "engine/plan/plan_graph.h"
#include "kernels/angle.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

// Shortest weighted paths from one station: their sum and how many stations they reach.
struct Reached {
    double sum = 0;
    std::int64_t count = 0;
};

// The stations' graph for many searches: neighbours lie near each other in memory, and a search
// touches its own network only.
class PathGraph {
public:
    explicit PathGraph(const Graph& graph) : place_(idx(graph.size()), -1) {
        edges_.begin.reserve(place_.size() + 1);
        std::vector<std::int32_t> order;  // breadth first, network after network
        order.reserve(place_.size());
        for (std::int32_t seed = 0; seed < graph.size(); ++seed) {
            if (place_[idx(seed)] >= 0) continue;
            networks_.push_back({static_cast<std::int32_t>(order.size()), 0, {seed}});
            place_[idx(seed)] = static_cast<std::int32_t>(order.size());
            order.push_back(seed);
            for (auto i = idx(networks_.back().first); i < order.size(); ++i) {
                graph.each(order[i], [&](std::int32_t n, double) {
                    if (place_[idx(n)] >= 0) return;
                    place_[idx(n)] = static_cast<std::int32_t>(order.size());
                    order.push_back(n);
                });
            }
            Network& mine = networks_.back();
            mine.end = static_cast<std::int32_t>(order.size());
            mine.stations.assign(order.begin() + mine.first, order.end());
            std::sort(mine.stations.begin(), mine.stations.end());
        }
        for (const std::int32_t v : order) {
            graph.each(v, [&](std::int32_t n, double overlap) {
                edges_.to.push_back(place_[idx(n)]);
                edges_.overlap.push_back(overlap);
            });
            edges_.begin.push_back(static_cast<std::int64_t>(edges_.to.size()));
        }
    }

    std::int32_t size() const { return edges_.size(); }

    // Ordered pairs of stations that a path joins.
    std::int64_t connected_pairs() const {
        std::int64_t pairs = 0;
        for (const Network& n : networks_) {
            pairs += static_cast<std::int64_t>(n.end - n.first) * (n.end - n.first - 1);
        }
        return pairs;
    }

    // Memory for searches one after another.
    struct Scratch {
        std::vector<double> distance;
        std::vector<std::vector<std::pair<double, std::int32_t>>> ring;
    };

    // Buckets of equal width instead of a heap: a station may be looked at again within its bucket,
    // and ends with the same shortest sum, which no order of search changes. A link is no longer
    // than 1, so a ring of buckets is enough.
    Reached from(std::int32_t station, Scratch& scratch) const {
        constexpr double width = 0.125;
        constexpr std::size_t buckets = 16;  // more than 1 / width + 2
        constexpr double far = std::numeric_limits<double>::infinity();
        const std::int32_t source = place_[idx(station)];
        const Network& network = *std::prev(
            std::upper_bound(networks_.begin(), networks_.end(), source,
                             [](std::int32_t v, const Network& n) { return v < n.first; }));
        std::vector<double>& distance = scratch.distance;
        const std::int32_t base = network.first;
        distance.assign(idx(network.end - base), far);
        scratch.ring.resize(buckets);
        std::size_t waiting = 1;
        distance[idx(source - base)] = 0;
        scratch.ring[0].emplace_back(0, source);
        for (std::size_t b = 0; waiting > 0; ++b) {
            auto& bucket = scratch.ring[b % buckets];
            for (std::size_t i = 0; i < bucket.size(); ++i) {  // it grows
                const auto [d, v] = bucket[i];
                if (d > distance[idx(v - base)]) continue;
                edges_.each(v, [&, d = d](std::int32_t n, double overlap) {
                    const double longer = d + (1 - overlap);
                    if (longer >= distance[idx(n - base)]) return;
                    distance[idx(n - base)] = longer;
                    // Never before the bucket at hand, whatever the division rounds to.
                    const auto to = std::max(b, static_cast<std::size_t>(longer / width));
                    scratch.ring[to % buckets].emplace_back(longer, n);
                    ++waiting;
                });
            }
            waiting -= bucket.size();
            bucket.clear();
        }
        Reached out;
        for (const std::int32_t s : network.stations) {
            if (s == station) continue;
            out.sum += distance[idx(place_[idx(s)] - base)];
            ++out.count;
        }
        return out;
    }

private:
    struct Network {
        std::int32_t first, end;             // places
        std::vector<std::int32_t> stations;  // ascending, for sums in a fixed order
    };
    Graph edges_;                      // by place
    std::vector<std::int32_t> place_;  // of each station
    std::vector<Network> networks_;
};

// The smallest overlap on a maximum spanning tree of the main network.
double bottleneck(const Plan& plan) {
    double weakest = 0;
    for (const Link& l : strongest_tree(plan)) {
        if (plan.stations[idx(l.from)].network == 0) weakest = l.overlap;
    }
    return weakest;
}

void measure_pieces(const PlanInput& in, const Plan& plan, const PiecePlaces& places,
                    double range_max_m, Metrics& m) {
    constexpr std::size_t most = 10;
    m.multiplicity.assign(most + 1, 0);
    m.range_tenths.assign(10, 0);
    m.incidence_tens.assign(9, 0);
    std::vector<std::uint8_t> count(in.piece_length_m.size(), 0);  // as far as `most`
    for (const Station& s : plan.stations) {
        const Vec2d eye = in.candidates[idx(s.candidate)].at;
        places.each(in.rows.row(s.candidate), [&](std::int32_t p, const PiecePlaces::Place& place) {
            if (count[idx(p)] < most) ++count[idx(p)];
            const Vec2d to = place.middle - eye;
            const auto tenth = static_cast<std::size_t>(10 * to.norm() / range_max_m);
            const double incidence =
                angle_upper_rad(std::abs(to.dot(place.along)), std::abs(cross(place.along, to)));
            const auto tens = static_cast<std::size_t>(incidence * 18 / pi);
            ++m.range_tenths[std::min<std::size_t>(tenth, 9)];
            ++m.incidence_tens[std::min<std::size_t>(tens, 8)];
        });
    }
    for (std::size_t p = 0; p < count.size(); ++p) {
        const double length = in.piece_length_m[p];
        m.length_all_m += length;
        ++m.multiplicity[count[p]];
        if (plan.pieces[p] == PieceStatus::no_viewpoint) continue;
        ++m.pieces_coverable;
        m.length_coverable_m += length;
        if (plan.pieces[p] == PieceStatus::unreached) ++m.pieces_unreached;
        if (plan.pieces[p] != PieceStatus::covered) continue;
        ++m.pieces_covered;
        m.length_covered_m += length;
    }
}

}  // namespace

PathMeasures measure_paths(const Threads& threads, const Graph& graph, std::int64_t most_sources) {
    PathMeasures m;
    const std::int64_t n = graph.size();
    if (n < 2) return m;
    m.sources = std::min(n, most_sources);
    const PathGraph paths(graph);
    std::vector<Reached> reached(idx(m.sources));
    threads.for_each(m.sources, 8, [&](std::int64_t from, std::int64_t to) {
        PathGraph::Scratch scratch;
        for (std::int64_t s = from; s < to; ++s) {
            reached[idx(s)] = paths.from(static_cast<std::int32_t>(s * n / m.sources), scratch);
        }
    });
    Reached all;
    for (const Reached& r : reached) {
        all.sum += r.sum;
        all.count += r.count;
    }
    if (all.count > 0) m.wapl = all.sum / static_cast<double>(all.count);
    const std::int64_t pairs = n * (n - 1);
    const std::int64_t connected = paths.connected_pairs();
    m.disconnected_pairs = (pairs - connected) / 2;
    m.wapl_penalty100 =
        (m.wapl * static_cast<double>(connected) + 100.0 * static_cast<double>(pairs - connected)) /
        static_cast<double>(pairs);
    if (m.sources < n && m.sources > 1 && all.count > 0) {
        double squares = 0;
        for (const Reached& r : reached) {
            const double off = r.sum - m.wapl * static_cast<double>(r.count);
            squares += off * off;
        }
        const auto k = static_cast<double>(m.sources);
        m.standard_error = std::sqrt((1 - k / static_cast<double>(n)) * squares / (k - 1) / k) /
                           (static_cast<double>(all.count) / k);
    }
    return m;
}

Metrics measure(const Threads& threads, const PlanInput& input, const Plan& plan,
                const PiecePlaces& places, double range_max_m) {
    Metrics m;
    const Graph graph = graph_of(plan);
    const Cuts cuts = find_cuts(graph);
    for (const Station& s : plan.stations)
        m.networks = std::max<std::int64_t>(m.networks, s.network + 1);
    m.bridges = cuts.bridges;
    m.articulation_stations = std::count(cuts.articulation.begin(), cuts.articulation.end(), 1);
    m.redundant_links = static_cast<std::int64_t>(plan.links.size()) -
                        static_cast<std::int64_t>(plan.stations.size()) + m.networks;
    m.bottleneck_overlap = bottleneck(plan);
    static_cast<PathMeasures&>(m) =
        measure_paths(threads, graph, graph.size() <= wapl_of_all ? wapl_of_all : wapl_sample);
    measure_pieces(input, plan, places, range_max_m, m);
    m.lower_bound = plan.certificate.bound();
    return m;
}

}  // namespace vfplan
