#include "io/formats/office_xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "io/features/role_tally.h"

namespace vfplan {
namespace {

constexpr double door_m = 0.9;
constexpr double from_corner_m = 0.08;
constexpr double reach_m = 0.3;  // the walls of two rooms lie up to a few pixels apart

struct Doorway {
    Vec2d a{0, 0};
    Vec2d b{0, 0};
    bool implicit = false;
};

// Whether a border turns at a point by more than tracing makes of a straight wall.
bool is_corner(const Ring& ring, std::size_t i) {
    constexpr double straight = 0.2618;  // 15 degrees
    const std::size_t n = ring.size();
    const Vec2d before = ring[i] - ring[(i + n - 1) % n];
    const Vec2d after = ring[(i + 1) % n] - ring[i];
    return std::abs(std::atan2(cross(before, after), before.dot(after))) > straight;
}

// Where a doorway lies that a border has at p: on the nearest edge, of two as near on the longer.
Doorway doorway_at(const Vec2d& p, const Ring& ring) {
    const std::size_t n = ring.size();
    std::size_t edge = 0;
    double nearest = 0;
    double longest = -1;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2d e = ring[(i + 1) % n] - ring[i];
        const double t = std::clamp((p - ring[i]).dot(e) / e.squaredNorm(), 0.0, 1.0);
        const double away = (ring[i] + t * e - p).norm();
        constexpr double same = 1e-6;
        if (longest >= 0 && away > nearest + same) continue;
        if (longest >= 0 && away > nearest - same && e.norm() <= longest) continue;
        edge = i;
        nearest = away;
        longest = e.norm();
    }
    const Vec2d u = (ring[(edge + 1) % n] - ring[edge]) / longest;
    const double along = std::clamp((p - ring[edge]).dot(u), 0.0, longest);
    // How far it is along the border to its corners.
    double before = along;
    for (std::size_t i = edge; !is_corner(ring, i) && before < 2 * door_m; i = (i + n - 1) % n) {
        before += (ring[i] - ring[(i + n - 1) % n]).norm();
    }
    double after = longest - along;
    for (std::size_t i = (edge + 1) % n; !is_corner(ring, i) && after < 2 * door_m;
         i = (i + 1) % n) {
        after += (ring[(i + 1) % n] - ring[i]).norm();
    }
    const double first = from_corner_m - before;
    const double last = after - from_corner_m;
    const double from = std::max(first, std::min(-door_m / 2, last - door_m));
    const double to = std::max(from, std::min(from + door_m, last));
    return {p + from * u, p + to * u, false};
}

// What of a border is left beside doorways.
std::vector<Line> walls_of(const Ring& ring, const std::vector<Doorway>& doorways) {
    std::vector<Line> out;
    Line now;
    const auto end_line = [&] {
        if (now.size() > 1) out.push_back(now);
        now.clear();
    };
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2d& a = ring[i];
        const Vec2d e = ring[(i + 1) % ring.size()] - a;
        // Stretches of the edge, from 0 to 1, that lie in doorways.
        std::vector<std::pair<double, double>> open;
        for (const Doorway& d : doorways) {
            const Vec2d u = (d.b - d.a).normalized();
            double from = 0;
            double to = 1;
            // As a + t e: along the doorway from 0 to door_m, beside it less than reach_m.
            const auto clip = [&](double at, double by, double lo, double hi) {
                if (std::abs(by) < 1e-12) {
                    if (at < lo || at > hi) to = -1;
                    return;
                }
                const double t0 = (lo - at) / by;
                const double t1 = (hi - at) / by;
                from = std::max(from, std::min(t0, t1));
                to = std::min(to, std::max(t0, t1));
            };
            clip((a - d.a).dot(u), e.dot(u), 0, (d.b - d.a).norm());
            clip(cross(u, a - d.a), cross(u, e), -reach_m, reach_m);
            if (from < to) open.emplace_back(from, to);
        }
        std::sort(open.begin(), open.end());
        double at = 0;
        for (const auto& [from, to] : open) {
            if (from > at) {
                if (now.empty()) now.push_back(a + at * e);
                now.push_back(a + from * e);
            }
            if (to > at) {
                end_line();
                at = to;
            }
        }
        if (at < 1) {
            if (now.empty()) now.push_back(a + at * e);
            now.push_back(a + e);
        }
    }
    end_line();
    return out;
}

}  // namespace

Drawing read_office_xml(const XmlDocument& document, const ReadOptions& options) {
    const pugi::xml_node root = document.root();
    Drawing out;
    RoleTally tally;
    out.set.how.format = "office and school XML";
    out.set.how.plan = true;
    const pugi::xml_node scale = root.child("scale");
    const double pixels = document.child_number(scale.child("represented_distance"), "value");
    const double real = document.child_number(scale.child("real_distance"), "value");
    const std::string unit = scale.child("real_distance").child("um").text().get();
    const double per_pixel = real / pixels * (unit == "cm" ? 0.01 : unit == "mm" ? 0.001 : 1);
    if (!(per_pixel > 0) || !(per_pixel < 1e3)) document.fail(scale, "it makes no sense");
    out.unit = {1, fmt::format("pixels of {:.4g} m, by the file", per_pixel)};

    struct Space {
        std::string id;
        std::string label;
        Ring ring;
    };
    std::vector<Space> spaces;
    std::vector<Doorway> doorways;
    std::set<std::string> known;
    for (const pugi::xml_node& floor : root.children("floor")) {
        for (const pugi::xml_node& s : floor.child("spaces").children("space")) {
            Space space{
                s.attribute("id").value(), s.child("labels").child("label").text().get(), {}};
            const auto place = [&](const pugi::xml_node& p) -> Vec2d {
                return Vec2d(document.number(p, "x"), -document.number(p, "y")) * per_pixel;
            };
            for (const pugi::xml_node& p : s.child("bounding_polygon").children("point")) {
                const Vec2d v = place(p);
                if (space.ring.empty() || v != space.ring.back()) space.ring.push_back(v);
            }
            if (space.ring.size() > 1 && space.ring.front() == space.ring.back()) {
                space.ring.pop_back();
            }
            if (space.ring.size() < 3) document.fail(s, "its bounding_polygon is no polygon");
            for (const pugi::xml_node& l :
                 s.child("space_representation").children("linesegment")) {
                if (std::string(l.child("class").text().get()) != "PORTAL") continue;
                if (!known.insert(l.attribute("id").value()).second) continue;
                doorways.push_back(doorway_at(place(l.child("point")), space.ring));
                doorways.back().implicit = std::string(l.child("type").text().get()) == "IMPLICIT";
            }
            spaces.push_back(std::move(space));
        }
    }
    if (spaces.empty()) document.fail(root, "there is no space in it");

    const auto add = [&](const std::string& text, Role own, const std::string& id) {
        return tally.add(out.set, options, text, own, id);
    };
    for (const Space& space : spaces) {
        const std::string label = space.label.empty() ? "space" : space.label;
        if (Feature* f = add(label, Role::room, space.id)) f->polygons.push_back({space.ring, {}});
        for (Line& wall : walls_of(space.ring, doorways)) {
            if (Feature* f = add("wall", Role::wall, space.id)) f->lines.push_back(std::move(wall));
        }
    }
    for (const Doorway& d : doorways) {
        if (Feature* f = add(d.implicit ? "implicit portal" : "portal", Role::door, "")) {
            f->lines.push_back({d.a, d.b});
        }
    }
    tally.add_to(out.set, "");
    return out;
}

}  // namespace vfplan
