#include "io/formats/structured3d.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/features/role_tally.h"
#include "io/formats/rings.h"

namespace vfplan {
namespace {

class House {
public:
    explicit House(const JsonAt& root) : root_(root) {
        const JsonAt junctions = root["junctions"];
        for (std::size_t i = 0; i < junctions.size(); ++i) {
            const JsonAt c = junctions.at(i)["coordinate"];
            places_.emplace_back(c.at(0).number(), c.at(1).number());
        }
        ends_ = marked(root["lineJunctionMatrix"]);
        lines_of_plane_ = marked(root["planeLineMatrix"]);
    }

    std::string plane_type(std::size_t plane) const {
        return root_["planes"].at(plane)["type"].text();
    }
    std::size_t planes() const { return lines_of_plane_.size(); }
    const Vec2d& place(std::size_t junction) const { return places_[junction]; }

    // The lines of a plane as pairs of junctions.
    std::vector<CornerPair> pairs(std::size_t plane) const {
        std::vector<CornerPair> out;
        for (const std::size_t line : lines_of_plane_[plane]) {
            if (line >= ends_.size() || ends_[line].size() != 2) continue;  // not bounded
            if (std::max(ends_[line][0], ends_[line][1]) >= places_.size()) continue;
            out.emplace_back(ends_[line][0], ends_[line][1]);
        }
        return out;
    }

    // The rings that the lines of a plane make.
    std::vector<Ring> rings(std::size_t plane) const {
        auto out = rings_along(pairs(plane), places_);
        if (!out) root_["planes"].at(plane).fail("the lines of this floor make no ring");
        return std::move(*out);
    }

private:
    // By row the columns with a 1.
    static std::vector<std::vector<std::size_t>> marked(const JsonAt& matrix) {
        std::vector<std::vector<std::size_t>> out(matrix.size());
        for (std::size_t r = 0; r < out.size(); ++r) {
            const JsonAt row = matrix.at(r);
            for (std::size_t c = 0; c < row.size(); ++c) {
                if (row.at(c).number() != 0) out[r].push_back(c);
            }
        }
        return out;
    }

    const JsonAt& root_;
    std::vector<Vec2d> places_;
    std::vector<std::vector<std::size_t>> ends_;
    std::vector<std::vector<std::size_t>> lines_of_plane_;
};

// A door or window from above: its lines, and the rectangle around them along the longest, a little
// larger, so that the faces of its wall are no place to doubt.
class Opening {
public:
    void add(const Vec2d& a, const Vec2d& b) {
        points_.push_back(a);
        points_.push_back(b);
        if ((b - a).norm() > along_.norm()) along_ = b - a;
    }
    bool empty() const { return along_.isZero(); }
    // Those that are not upright.
    std::vector<Line> lines() const {
        std::vector<Line> out;
        for (std::size_t i = 0; i < points_.size(); i += 2) {
            if (points_[i] != points_[i + 1]) out.push_back({points_[i], points_[i + 1]});
        }
        return out;
    }
    Ring ring() const {
        constexpr double beyond_mm = 10;
        const Vec2d u = along_.normalized();
        const Vec2d v(-u.y(), u.x());
        Box box;  // in u and v
        for (const Vec2d& p : points_) box.add({p.dot(u), p.dot(v)});
        const Vec2d margin(beyond_mm, beyond_mm);
        const Vec2d lo = box.min - margin;
        const Vec2d hi = box.max + margin;
        return {lo.x() * u + lo.y() * v, hi.x() * u + lo.y() * v, hi.x() * u + hi.y() * v,
                lo.x() * u + hi.y() * v};
    }

private:
    std::vector<Vec2d> points_;
    Vec2d along_{0, 0};
};

}  // namespace

Drawing read_structured3d(const JsonAt& root, const ReadOptions& options) {
    const House house(root);
    Drawing out;
    RoleTally tally;
    out.set.how.format = "Structured3D";
    out.set.how.plan = true;
    out.unit = {0.001, "millimetres (Structured3D)"};
    const auto add = [&](std::size_t number, const std::string& text, Role own, Feature f) {
        Feature* added = tally.add(out.set, options, text, own, text);
        if (added == nullptr) return;
        added->number = static_cast<std::int64_t>(number) + 1;
        added->polygons = std::move(f.polygons);
        added->lines = std::move(f.lines);
    };
    const JsonAt semantics = root["semantics"];
    for (std::size_t s = 0; s < semantics.size(); ++s) {
        const std::string type = semantics.at(s)["type"].text();
        const JsonAt planes = semantics.at(s)["planeID"];
        if (type == "outwall") {
            tally.count(type, {}, "format");  // the rooms' borders are the walls
            continue;
        }
        const bool opening = type == "door" || type == "window";
        Opening hole;
        Feature room;
        Feature walls;
        for (std::size_t i = 0; i < planes.size(); ++i) {
            const std::size_t plane = planes.at(i).index(house.planes());
            if (opening) {
                for (const auto& [a, b] : house.pairs(plane)) {
                    hole.add(house.place(a), house.place(b));
                }
            } else if (house.plane_type(plane) == "floor") {
                for (Ring& ring : house.rings(plane)) {
                    Line wall = ring;
                    wall.push_back(wall.front());
                    walls.lines.push_back(std::move(wall));
                    room.polygons.push_back({std::move(ring), {}});
                }
            }
        }
        if (opening && !hole.empty()) {
            Feature f;
            if (type == "door") {
                f.polygons.push_back({hole.ring(), {}});
            } else {
                f.lines = hole.lines();
            }
            add(s, type, type == "door" ? Role::door : Role::window, std::move(f));
        } else if (!room.polygons.empty()) {
            add(s, type, Role::room, std::move(room));
            add(s, "wall of " + type, Role::wall, std::move(walls));
        }
    }
    tally.add_to(out.set, "");
    return out;
}

}  // namespace vfplan
