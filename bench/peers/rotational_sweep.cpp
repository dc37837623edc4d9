#include "bench/peers/rotational_sweep.h"

#include <algorithm>
#include <cstdint>
#include <set>
#include <tuple>

#include "kernels/angle.h"

namespace vfplan::peers {
namespace {

// A wall as the eye sees it, ends relative to the eye, counter-clockwise from begin to end.
struct Edge {
    Vec2d begin;
    Vec2d end;
    const Wall* wall;
};

struct Event {
    double angle;  // pseudo-angle of the end
    bool begins;
    std::int32_t edge;
};

// Whether p stands before q on every ray that meets both. They do not cross.
bool before(const Edge& p, const Edge& q) {
    const double begin_of_p = orient(q.begin, q.end, p.begin);
    const double end_of_p = orient(q.begin, q.end, p.end);
    // The eye is on the left of both.
    if (begin_of_p >= 0 && end_of_p >= 0 && (begin_of_p > 0 || end_of_p > 0)) return true;
    if (begin_of_p <= 0 && end_of_p <= 0 && (begin_of_p < 0 || end_of_p < 0)) return false;
    return orient(p.begin, p.end, q.begin) <= 0 && orient(p.begin, p.end, q.end) <= 0;
}

}  // namespace

double RotationalSweep::vf_rad(const Vec2d& eye, const Scanner& scanner) const {
    std::vector<Edge> edges;
    std::vector<Event> events;
    for (const Wall& w : walls_) {
        Edge e{w.a - eye, w.b - eye, &w};
        const double area = cross(e.begin, e.end);
        if (area == 0) continue;  // edge-on
        if (area < 0) std::swap(e.begin, e.end);
        const auto id = static_cast<std::int32_t>(edges.size());
        edges.push_back(e);
        events.push_back({pseudo_angle(e.begin), true, id});
        events.push_back({pseudo_angle(e.end), false, id});
    }
    // At one angle walls end before others begin.
    std::sort(events.begin(), events.end(), [](const Event& a, const Event& b) {
        return std::tuple(a.angle, a.begins, a.edge) < std::tuple(b.angle, b.begins, b.edge);
    });
    const auto nearer = [&](std::int32_t a, std::int32_t b) {
        if (a == b) return false;
        const Edge& p = edges[static_cast<std::size_t>(a)];
        const Edge& q = edges[static_cast<std::size_t>(b)];
        if (before(p, q)) return true;
        return before(q, p) ? false : a < b;
    };
    std::set<std::int32_t, decltype(nearer)> met(nearer);
    for (std::size_t i = 0; i < edges.size(); ++i) {  // met by the ray along +x
        if (pseudo_angle(edges[i].begin) > pseudo_angle(edges[i].end)) {
            met.insert(static_cast<std::int32_t>(i));
        }
    }
    const double tan_limit = tan_incidence(scanner);
    double sum = 0;
    Vec2d from(1, 0);
    const auto see = [&](std::int32_t nearest, const Vec2d& to) {
        const Edge& e = edges[static_cast<std::size_t>(nearest)];
        if (e.wall->scanned) {
            sum += observed_angle_rad(*e.wall, scanner, tan_limit, eye, from, to);
        }
    };
    for (const Event& event : events) {
        const Edge& e = edges[static_cast<std::size_t>(event.edge)];
        const std::int32_t nearest = met.empty() ? -1 : *met.begin();
        if (event.begins) {
            met.insert(event.edge);
        } else {
            met.erase(event.edge);
        }
        if ((met.empty() ? -1 : *met.begin()) == nearest) continue;
        const Vec2d& to = event.begins ? e.begin : e.end;
        if (nearest >= 0) see(nearest, to);
        from = to;
    }
    if (!met.empty()) see(*met.begin(), Vec2d(1, 0));
    return sum;
}

}  // namespace vfplan::peers
