#include "io/formats/rings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "kernels/disjoint_sets.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

bool surrounds(const Ring& ring, const Vec2d& p) {
    bool odd = false;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2d& a = ring[i];
        const Vec2d& b = ring[(i + 1) % ring.size()];
        if ((a.y() > p.y()) == (b.y() > p.y())) continue;
        if ((orient(a, b, p) > 0) == (b.y() > a.y())) odd = !odd;
    }
    return odd;
}

// Rings that do not cross may touch: the one lies in the other when most of its corners do.
bool lies_in(const Ring& inner, const Ring& outer) {
    std::size_t in = 0;
    for (std::size_t i = 0; i < inner.size(); ++i) {
        in += surrounds(outer, (inner[i] + inner[(i + 1) % inner.size()]) / 2);
    }
    return 2 * in > inner.size();
}

}  // namespace

std::vector<Polygon> polygons_of(const std::vector<Ring>& rings) {
    std::vector<std::size_t> by_size(rings.size());
    std::iota(by_size.begin(), by_size.end(), std::size_t{0});
    std::vector<Box> box(rings.size());
    for (std::size_t i = 0; i < rings.size(); ++i) {
        for (const Vec2d& v : rings[i]) box[i].add(v);
    }
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::size_t a, std::size_t b) {
        return box[a].size().prod() > box[b].size().prod();
    });
    struct Placed {
        std::size_t ring;
        std::size_t depth;    // rings around it
        std::size_t polygon;  // that it bounds
    };
    std::vector<Placed> placed;
    std::vector<Polygon> out;
    for (const std::size_t i : by_size) {
        const Placed* around = nullptr;  // the smallest
        for (const Placed& p : placed) {
            if (!box[p.ring].contains(box[i].min) || !box[p.ring].contains(box[i].max)) continue;
            if (lies_in(rings[i], rings[p.ring])) around = &p;
        }
        const std::size_t depth = around == nullptr ? 0 : around->depth + 1;
        if (depth % 2 == 1) {
            out[around->polygon].holes.push_back(rings[i]);
            placed.push_back({i, depth, around->polygon});
        } else {
            out.push_back({rings[i], {}});
            placed.push_back({i, depth, out.size() - 1});
        }
    }
    return out;
}

std::optional<std::vector<Ring>> rings_along(const std::vector<CornerPair>& edges,
                                             const std::vector<Vec2d>& places) {
    std::map<std::size_t, std::vector<std::size_t>> next;
    for (const auto& [a, b] : edges) {
        next[a].push_back(b);
        next[b].push_back(a);
    }
    const auto take = [&](std::size_t from, std::size_t to) {
        auto& ways = next[from];
        ways.erase(std::find(ways.begin(), ways.end(), to));
        if (ways.empty()) next.erase(from);
    };
    std::vector<Ring> out;
    while (!next.empty()) {
        const std::size_t first = next.begin()->first;
        Ring ring;
        std::size_t at = first;
        do {
            ring.push_back(places[at]);
            const auto ways = next.find(at);
            if (ways == next.end()) return {};
            const std::size_t to = ways->second.back();
            take(at, to);
            take(to, at);
            at = to;
        } while (at != first);
        if (ring.size() > 2) out.push_back(std::move(ring));
    }
    return out;
}

std::vector<Polygon> united(const std::vector<std::vector<Corners>>& faces,
                            const std::vector<Vec2d>& places) {
    const auto each_edge = [](const std::vector<Corners>& face, auto&& f) {
        for (const Corners& ring : face) {
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const std::size_t a = ring[i];
                const std::size_t b = ring[(i + 1) % ring.size()];
                if (a != b) f(CornerPair(std::min(a, b), std::max(a, b)));
            }
        }
    };
    DisjointSets together(static_cast<std::int64_t>(faces.size()));
    const auto number = [](std::size_t i) { return static_cast<std::int32_t>(i); };
    std::map<CornerPair, std::size_t> first;
    for (std::size_t i = 0; i < faces.size(); ++i) {
        each_edge(faces[i], [&](const CornerPair& e) {
            const auto [at, is_new] = first.emplace(e, i);
            if (!is_new) together.merge(number(at->second), number(i));
        });
    }
    std::map<std::int32_t, std::set<CornerPair>> border;  // by the set of faces
    for (std::size_t i = 0; i < faces.size(); ++i) {
        std::set<CornerPair>& edges = border[together.root(number(i))];
        each_edge(faces[i], [&](const CornerPair& e) {
            if (!edges.insert(e).second) edges.erase(e);
        });
    }
    std::vector<Polygon> out;
    for (const auto& [set, edges] : border) {
        // Every corner of rings has an even number of edges, also when shared ones go.
        const auto rings = rings_along({edges.begin(), edges.end()}, places);
        for (Polygon& p : polygons_of(*rings)) out.push_back(std::move(p));
    }
    return out;
}

}  // namespace vfplan
