#include "kernels/transitions.h"

#include <cmath>

#include "kernels/shadow.h"

namespace vfplan {
namespace {

constexpr double past_rad = 1e-9;  // how far beside a wall's end a ray is cast
constexpr int rounds_most = 48;    // bisection from 2 pi / 16 ends at past_rad long before
constexpr std::int32_t nothing = -1;

// A ray and what it met. `border` is the point through which the change of wall between this ray
// and the next one runs, once that is known.
struct Node {
    Vec2d direction;
    std::int32_t wall;
    bool explained = false;
    Vec2d border{0, 0};  // relative to the eye
};

// The walls' ends as the eye sees them.
class Ends {
public:
    Ends(const std::vector<Wall>& walls, Vec2d eye) : walls_(walls), eye_(std::move(eye)) {}

    const Wall& wall(std::int32_t id) const { return walls_[static_cast<std::size_t>(id)]; }
    Side side(std::int32_t id) const {
        return orient(wall(id).a, wall(id).b, eye_) >= 0 ? left : right;
    }
    // Clockwise-most and counter-clockwise-most point, relative to the eye.
    Vec2d begin(std::int32_t id) const {
        return (side(id) == left ? wall(id).a : wall(id).b) - eye_;
    }
    Vec2d end(std::int32_t id) const { return (side(id) == left ? wall(id).b : wall(id).a) - eye_; }
    // Distance to the wall's line along d, in lengths of d.
    double along(std::int32_t id, const Vec2d& d) const {
        const Vec2d e = wall(id).b - wall(id).a;
        return cross(wall(id).a - eye_, e) / cross(d, e);
    }
    // Metres from wall.a to where the ray d meets the wall's line, kept on the wall.
    double metres_at(std::int32_t id, const Vec2d& d) const {
        return shadow_m(wall(id), wall(id).length_m(), eye_, d);
    }

private:
    const std::vector<Wall>& walls_;
    Vec2d eye_;
};

bool between(const Vec2d& from, const Vec2d& d, const Vec2d& to) {
    return cross(from, d) > 0 && cross(d, to) > 0;
}

Vec2d beside(const Vec2d& d, double rad) {
    const Vec2d unit = d / d.norm();
    return unit + rad * Vec2d(-unit.y(), unit.x());
}

// What to do about one change of wall: accept a border, or cast a ray first.
struct Proposal {
    enum Kind { accept, look_past_end, look_before_begin, bisect } kind;
    Vec2d border{0, 0};
};

Proposal propose(const Ends& ends, const Node& a, const Node& b) {
    const bool wall_a = a.wall != nothing;
    const bool wall_b = b.wall != nothing;
    const Vec2d end_a = wall_a ? ends.end(a.wall) : Vec2d(0, 0);
    const Vec2d begin_b = wall_b ? ends.begin(b.wall) : Vec2d(0, 0);
    const bool ends_here = wall_a && between(a.direction, end_a, b.direction);
    const bool begins_here = wall_b && between(a.direction, begin_b, b.direction);
    if (ends_here && begins_here) {
        if (end_a == begin_b) return {Proposal::accept, end_a};
        if (cross(end_a, begin_b) > 0) return {Proposal::look_past_end, end_a};  // a gap between
        // Both cover the stretch from begin_b to end_a; the nearer one is what is seen there.
        const bool a_nearer = ends.along(a.wall, begin_b) < 1;
        return a_nearer ? Proposal{Proposal::look_past_end, end_a}
                        : Proposal{Proposal::look_before_begin, begin_b};
    }
    if (ends_here) return {Proposal::look_past_end, end_a};
    if (begins_here) return {Proposal::look_before_begin, begin_b};
    if (cross(a.direction, b.direction) < past_rad) {
        return {Proposal::accept, a.direction + b.direction};
    }
    return {Proposal::bisect, a.direction + b.direction};
}

void emit(const Ends& ends, const std::vector<Node>& nodes, View& out) {
    const std::size_t n = nodes.size();
    std::size_t start = 0;  // the first ray behind a change of wall
    while (start < n && nodes[start].wall == nodes[(start + n - 1) % n].wall) ++start;
    if (start == n) return;  // nothing anywhere: no wall can surround an eye alone
    for (std::size_t k = 0; k < n;) {
        const std::size_t first = (start + k) % n;
        const std::int32_t wall = nodes[first].wall;
        std::size_t run = 1;
        while (k + run < n && nodes[(start + k + run) % n].wall == wall) ++run;
        if (wall != nothing) {
            const Vec2d& from = nodes[(first + n - 1) % n].border;
            const Vec2d& to = nodes[(first + run - 1) % n].border;
            out.push_back(
                {wall, ends.side(wall), ends.metres_at(wall, from), ends.metres_at(wall, to), 0});
        }
        k += run;
    }
}

}  // namespace

void follow_transitions(const std::vector<Wall>& walls, const Vec2d& eye,
                        const std::vector<Vec2d>& directions, const TraceRays& trace, View& out) {
    out.clear();
    const Ends ends(walls, eye);
    std::vector<std::int32_t> met;
    trace(directions, met);
    std::vector<Node> nodes;
    nodes.reserve(2 * directions.size());
    for (std::size_t i = 0; i < directions.size(); ++i) nodes.push_back({directions[i], met[i]});

    std::vector<Proposal> proposals;
    std::vector<Vec2d> rays;
    std::vector<Node> next;
    for (int round = 0; round < rounds_most; ++round) {
        proposals.assign(nodes.size(), {Proposal::accept, {0, 0}});
        rays.clear();
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            Node& a = nodes[i];
            const Node& b = nodes[(i + 1) % nodes.size()];
            if (a.explained || a.wall == b.wall) continue;
            const Proposal& p = proposals[i] = propose(ends, a, b);
            if (p.kind == Proposal::accept) {
                a.explained = true;
                a.border = p.border;
                continue;
            }
            rays.push_back(p.kind == Proposal::look_past_end       ? beside(p.border, past_rad)
                           : p.kind == Proposal::look_before_begin ? beside(p.border, -past_rad)
                                                                   : p.border / p.border.norm());
        }
        if (rays.empty()) break;
        trace(rays, met);
        next.clear();
        std::size_t ray = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            Node& a = nodes[i];
            const Node& b = nodes[(i + 1) % nodes.size()];
            const Proposal& p = proposals[i];
            next.push_back(a);
            if (p.kind == Proposal::accept) continue;
            const Node seen{rays[ray], met[ray]};
            ++ray;
            if (p.kind == Proposal::look_past_end) {
                next.back().explained = true;
                next.back().border = p.border;
                if (seen.wall != b.wall) next.push_back(seen);
            } else if (p.kind == Proposal::look_before_begin) {
                if (seen.wall != a.wall) next.push_back(seen);
                next.back().explained = true;
                next.back().border = p.border;
            } else {
                next.push_back(seen);
            }
        }
        nodes.swap(next);
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!nodes[i].explained) {
            nodes[i].border = nodes[i].direction + nodes[(i + 1) % nodes.size()].direction;
        }
    }
    emit(ends, nodes, out);
}

}  // namespace vfplan
