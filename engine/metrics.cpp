#include "engine/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "engine/disjoint_sets.h"
#include "kernels/angle.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

Graph graph_of(const Plan& plan) {
    std::vector<OverlapPair> pairs;
    for (const Link& l : plan.links) pairs.push_back({l.from, l.to, l.overlap});
    return make_graph(static_cast<std::int32_t>(plan.stations.size()), pairs);
}

// Shortest weighted paths from one station: their sum and how many stations they reach.
struct Reached {
    double sum = 0;
    std::int64_t count = 0;
};

Reached paths_from(const Graph& graph, std::int32_t source) {
    using Entry = std::pair<double, std::int32_t>;
    std::vector<double> distance(at(graph.size()), std::numeric_limits<double>::infinity());
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance[at(source)] = 0;
    queue.emplace(0, source);
    while (!queue.empty()) {
        const auto [d, v] = queue.top();
        queue.pop();
        if (d > distance[at(v)]) continue;
        graph.each(v, [&, d = d](std::int32_t n, double overlap) {
            const double far = d + (1 - overlap);
            if (far >= distance[at(n)]) return;
            distance[at(n)] = far;
            queue.emplace(far, n);
        });
    }
    Reached out;
    for (std::int32_t v = 0; v < graph.size(); ++v) {
        if (v == source || std::isinf(distance[at(v)])) continue;
        out.sum += distance[at(v)];
        ++out.count;
    }
    return out;
}

// The smallest overlap on a maximum spanning tree of the main network.
double bottleneck(const Plan& plan) {
    DisjointSets sets(static_cast<std::int64_t>(plan.stations.size()));
    std::vector<Link> links;
    for (const Link& l : plan.links) {
        if (plan.stations[at(l.from)].network == 0) links.push_back(l);
    }
    std::stable_sort(links.begin(), links.end(),
                     [](const Link& a, const Link& b) { return a.overlap > b.overlap; });
    double weakest = 0;
    for (const Link& l : links) {
        if (sets.together(l.from, l.to)) continue;
        sets.merge(l.from, l.to);
        weakest = l.overlap;
    }
    return weakest;
}

void measure_pieces(const PlanInput& in, const Plan& plan, const std::vector<Wall>& walls,
                    double range_max_m, Metrics& m) {
    constexpr std::size_t most = 10;
    m.multiplicity.assign(most + 1, 0);
    m.range_tenths.assign(10, 0);
    m.incidence_tens.assign(9, 0);
    std::vector<std::size_t> count(at(in.pieces.size()), 0);
    for (const Station& s : plan.stations) {
        const Vec2d eye = in.candidates[at(s.candidate)].at;
        for (const Seen* k = in.table.row_begin(s.candidate); k != in.table.row_end(s.candidate);
             ++k) {
            ++count[at(k->piece)];
            const auto p = at(k->piece);
            const Wall& wall = walls[at(in.pieces.wall[p])];
            const Vec2d to = wall.at((in.pieces.s0_m[p] + in.pieces.s1_m[p]) / 2) - eye;
            const Vec2d e = (wall.b - wall.a).normalized();
            const auto tenth = static_cast<std::size_t>(10 * to.norm() / range_max_m);
            const double incidence = angle_upper_rad(std::abs(to.dot(e)), std::abs(cross(e, to)));
            const auto tens = static_cast<std::size_t>(incidence * 18 / pi);
            ++m.range_tenths[std::min<std::size_t>(tenth, 9)];
            ++m.incidence_tens[std::min<std::size_t>(tens, 8)];
        }
    }
    for (std::size_t p = 0; p < count.size(); ++p) {
        const double length = in.pieces.length_m(static_cast<std::int64_t>(p));
        m.length_all_m += length;
        ++m.multiplicity[std::min(count[p], most)];
        if (plan.pieces[p] == PieceStatus::no_viewpoint) continue;
        ++m.pieces_coverable;
        m.length_coverable_m += length;
        if (plan.pieces[p] == PieceStatus::unreached) ++m.pieces_unreached;
        if (plan.pieces[p] != PieceStatus::covered) continue;
        ++m.pieces_covered;
        m.length_covered_m += length;
    }
}

// Ordered pairs of stations that a path joins.
std::int64_t connected_pairs(const Graph& graph) {
    std::vector<std::int64_t> members;
    for (const std::int32_t c : components(graph)) {
        if (at(c) >= members.size()) members.resize(at(c) + 1, 0);
        ++members[at(c)];
    }
    std::int64_t pairs = 0;
    for (const std::int64_t m : members) pairs += m * (m - 1);
    return pairs;
}

}  // namespace

PathMeasures measure_paths(const Threads& threads, const Graph& graph, std::int64_t most_sources) {
    PathMeasures m;
    const std::int64_t n = graph.size();
    if (n < 2) return m;
    m.sources = std::min(n, most_sources);
    std::vector<Reached> reached(at(m.sources));
    threads.for_each(m.sources, 8, [&](std::int64_t from, std::int64_t to) {
        for (std::int64_t s = from; s < to; ++s) {
            reached[at(s)] = paths_from(graph, static_cast<std::int32_t>(s * n / m.sources));
        }
    });
    Reached all;
    for (const Reached& r : reached) {
        all.sum += r.sum;
        all.count += r.count;
    }
    if (all.count > 0) m.wapl = all.sum / static_cast<double>(all.count);
    const std::int64_t pairs = n * (n - 1);
    const std::int64_t connected = connected_pairs(graph);
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
                const std::vector<Wall>& walls, double range_max_m) {
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
    measure_pieces(input, plan, walls, range_max_m, m);
    m.lower_bound = static_cast<std::int64_t>(plan.bound_pieces.size());
    const auto n = static_cast<double>(plan.stations.size());
    if (n > 0) m.gap = (n - static_cast<double>(m.lower_bound)) / n;
    return m;
}

}  // namespace vfplan
