#include "engine/graphs/shortcuts.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace vfplan {
namespace {

class Ways {
public:
    Ways(const Graph& graph, const std::vector<std::int32_t>& chosen)
        : graph_(graph), nodes_(chosen), place_(idx(graph.size()), -1) {
        for (std::size_t i = 0; i < nodes_.size(); ++i) {
            place_[idx(nodes_[i])] = static_cast<std::int32_t>(i);
        }
        for (std::size_t i = 0; i < nodes_.size(); ++i) way_.push_back(ways_from(nodes_[i]));
    }

    // Takes the best node and returns it; -1 where none makes ways shorter.
    std::int32_t take_one() {
        // Only so many are looked at closely, from so many nodes.
        constexpr std::size_t looked_at = 128;
        std::vector<std::pair<double, std::int32_t>> saving;
        for (std::int32_t c = 0; c < graph_.size(); ++c) {
            const double saved = place_[idx(c)] < 0 ? saved_between_two(c) : 0;
            if (saved > least) saving.emplace_back(-saved, c);
        }
        std::sort(saving.begin(), saving.end());
        if (saving.size() > looked_at) saving.resize(looked_at);
        double best = sum_with({});
        std::int32_t node = -1;
        for (const auto& [saved, c] : saving) {
            const double sum = sum_with(ways_to(c));
            if (sum >= best - least) continue;
            best = sum;
            node = c;
        }
        if (node >= 0) take(node);
        return node;
    }

private:
    static constexpr double least = 1e-9;

    std::vector<double> ways_from(std::int32_t node) const {
        std::vector<double> way(nodes_.size(), std::numeric_limits<double>::infinity());
        using Entry = std::pair<double, std::int32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
        way[idx(place_[idx(node)])] = 0;
        open.emplace(0, node);
        while (!open.empty()) {
            const auto [length, v] = open.top();
            open.pop();
            if (length > way[idx(place_[idx(v)])]) continue;
            graph_.each(v, [&, from = length](std::int32_t n, double overlap) {
                if (place_[idx(n)] < 0) return;
                double& there = way[idx(place_[idx(n)])];
                if (from + (1 - overlap) >= there) return;
                there = from + (1 - overlap);
                open.emplace(there, n);
            });
        }
        return way;
    }

    // How much shorter two of its neighbours come together over a node.
    double saved_between_two(std::int32_t c) {
        near_.clear();
        graph_.each(c, [&](std::int32_t n, double overlap) {
            if (place_[idx(n)] >= 0) near_.emplace_back(place_[idx(n)], 1 - overlap);
        });
        double saved = 0;
        for (std::size_t i = 0; i < near_.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                saved = std::max(saved, way_[idx(near_[i].first)][idx(near_[k].first)] -
                                            near_[i].second - near_[k].second);
            }
        }
        return saved;
    }

    std::vector<double> ways_to(std::int32_t c) const {
        std::vector<double> way(nodes_.size(), std::numeric_limits<double>::infinity());
        graph_.each(c, [&](std::int32_t n, double overlap) {
            if (place_[idx(n)] < 0) return;
            const std::vector<double>& from = way_[idx(place_[idx(n)])];
            for (std::size_t v = 0; v < way.size(); ++v) {
                way[v] = std::min(way[v], from[v] + (1 - overlap));
            }
        });
        return way;
    }

    // Of the ways between nodes, with another one to which there are such ways (none: as it is). In
    // large parts of those from some nodes only.
    double sum_with(const std::vector<double>& to) const {
        constexpr std::size_t sources = 400;
        const std::size_t n = nodes_.size();
        const std::size_t stride = (n + sources - 1) / sources;
        double sum = 0;
        for (std::size_t u = 0; u < n; u += stride) {
            const std::vector<double>& way = way_[u];
            for (std::size_t v = 0; v < n; ++v) {
                sum += to.empty() ? way[v] : std::min(way[v], to[u] + to[v]);
            }
        }
        return sum;
    }

    void take(std::int32_t c) {
        const std::vector<double> to = ways_to(c);
        for (std::size_t u = 0; u < nodes_.size(); ++u) {
            for (std::size_t v = 0; v < nodes_.size(); ++v) {
                way_[u][v] = std::min(way_[u][v], to[u] + to[v]);
            }
            way_[u].push_back(to[u]);
        }
        way_.push_back(to);
        way_.back().push_back(0);
        place_[idx(c)] = static_cast<std::int32_t>(nodes_.size());
        nodes_.push_back(c);
    }

    const Graph& graph_;
    std::vector<std::int32_t> nodes_;
    std::vector<std::int32_t> place_;       // among them, of each node of the graph; -1: not chosen
    std::vector<std::vector<double>> way_;  // between them
    std::vector<std::pair<std::int32_t, double>> near_;  // of the node looked at
};

}  // namespace

std::vector<std::int32_t> shortcuts(const Graph& graph, const std::vector<std::int32_t>& chosen,
                                    std::int64_t most) {
    std::vector<std::int32_t> out;
    if (most <= 0 || chosen.size() > shortened_most) return out;
    Ways ways(graph, chosen);
    while (static_cast<std::int64_t>(out.size()) < most) {
        const std::int32_t taken = ways.take_one();
        if (taken < 0) break;
        out.push_back(taken);
    }
    return out;
}

}  // namespace vfplan
