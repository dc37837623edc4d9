#include "io/formats/sweet_home.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "io/features/role_tally.h"

namespace vfplan {
namespace {

struct HomeWall {
    std::string id;
    std::string at_start;  // the walls that it is joined to
    std::string at_end;
    Line middle;  // two points, or more where it is round
    double thickness = 0;

    // The way out of the wall at an end, and where that is.
    const Vec2d& end(bool start) const { return start ? middle.front() : middle.back(); }
    Vec2d outwards(bool start) const {
        const std::size_t n = middle.size();
        return (start ? middle[0] - middle[1] : middle[n - 1] - middle[n - 2]).normalized();
    }
};

// The middle line of a round wall: an arc over the chord from a to b.
Line arc(const Vec2d& a, const Vec2d& b, double extent) {
    constexpr double step = 0.1;  // rad
    const auto n = static_cast<int>(std::clamp(std::ceil(std::abs(extent) / step), 1.0, 1000.0));
    const Vec2d chord = b - a;
    const Vec2d normal(-chord.y(), chord.x());
    const Vec2d centre = (a + b) / 2 + normal / (2 * std::tan(extent / 2));
    Line out;
    for (int i = 0; i <= n; ++i) {
        const double turn = extent * i / n;
        const Vec2d r = a - centre;
        out.emplace_back(centre + Vec2d(std::cos(turn) * r.x() - std::sin(turn) * r.y(),
                                        std::sin(turn) * r.x() + std::cos(turn) * r.y()));
    }
    return out;
}

Vec2d left_of(const Vec2d& way) { return {-way.y(), way.x()}; }

// Where two lines, each a place and a way, meet; empty when they run almost side by side.
std::optional<Vec2d> meeting(const Vec2d& p, const Vec2d& u, const Vec2d& q, const Vec2d& v) {
    const double turn = cross(u, v);
    if (std::abs(turn) < 1e-3) return {};
    return p + u * (cross(q - p, v) / turn);
}

class Home {
public:
    Home(const XmlDocument& document, const ReadOptions& options)
        : document_(document), options_(options) {
        choose_level();
        for (const pugi::xml_node& w : document.root().children("wall")) {
            if (on_level(w)) add_wall(w);
        }
        for (std::size_t i = 0; i < walls_.size(); ++i) number_of_.emplace(walls_[i].id, i);
    }

    Drawing read() {
        out_.set.how.format = "Sweet Home 3D";
        out_.set.how.plan = true;
        out_.set.how.layers = true;
        out_.unit = {0.01, "centimetres (Sweet Home 3D)"};
        for (const HomeWall& w : walls_) {
            add("wall", Role::wall, w.id, {outline(w)});
        }
        for (const pugi::xml_node& r : document_.root().children("room")) {
            if (on_level(r)) add_room(r);
        }
        add_pieces(document_.root());
        tally_.add_to(out_.set, level_.empty() ? "" : options_.layer);
        return std::move(out_);
    }

private:
    void choose_level() {
        std::map<std::string, std::string> levels;  // name -> id
        std::string names;
        for (const pugi::xml_node& l : document_.root().children("level")) {
            const std::string name = l.attribute("name").value();
            levels[name] = l.attribute("id").value();
            names += (names.empty() ? "" : ", ") + name;
        }
        if (levels.size() > 1 && options_.layer.empty()) {
            document_.fail(document_.root(),
                           fmt::format("{} levels, and site.layer names none; choose one of: {}",
                                       levels.size(), names));
        }
        if (options_.layer.empty()) return;
        const auto found = levels.find(options_.layer);
        if (found == levels.end()) {
            document_.fail(document_.root(),
                           fmt::format("no level '{}'; the home has: {}", options_.layer,
                                       names.empty() ? "none" : names));
        }
        level_ = found->second;
    }
    bool on_level(const pugi::xml_node& node) const {
        return level_.empty() || level_ == node.attribute("level").value();
    }

    void add_wall(const pugi::xml_node& node) {
        HomeWall w;
        w.id = node.attribute("id").value();
        w.at_start = node.attribute("wallAtStart").value();
        w.at_end = node.attribute("wallAtEnd").value();
        w.thickness = document_.number(node, "thickness");
        if (!(w.thickness > 0)) document_.fail(node, "its thickness is not above 0");
        const Vec2d a(document_.number(node, "xStart"), -document_.number(node, "yStart"));
        const Vec2d b(document_.number(node, "xEnd"), -document_.number(node, "yEnd"));
        if (a == b) return;
        const double extent = document_.number(node, "arcExtent", 0);
        constexpr double straight = 1e-3;
        w.middle = std::abs(extent) < straight ? Line{a, b} : arc(a, b, -extent);
        walls_.push_back(std::move(w));
    }

    // The corner at an end, on the left or right hand of who leaves the wall there: where its side
    // meets that of the wall joined to it.
    Vec2d corner(const HomeWall& w, bool start, double hand) const {
        const Vec2d out = w.outwards(start);
        const Vec2d plain = w.end(start) + hand * w.thickness / 2 * left_of(out);
        const auto found = number_of_.find(start ? w.at_start : w.at_end);
        if (found == number_of_.end()) return plain;
        const HomeWall& next = walls_[found->second];
        if (&next == &w) return plain;
        const bool joins_start =
            (next.end(true) - w.end(start)).norm() <= (next.end(false) - w.end(start)).norm();
        const Vec2d on = -next.outwards(joins_start);
        const Vec2d beside = next.end(joins_start) + hand * next.thickness / 2 * left_of(on);
        const auto at = meeting(plain, out, beside, on);
        const double farthest = 2 * std::max(w.thickness, next.thickness);
        return at && (*at - w.end(start)).norm() <= farthest ? *at : plain;
    }

    Polygon outline(const HomeWall& w) const {
        const std::size_t n = w.middle.size();
        Ring ring;
        // Along one side and back along the other. Between, in the middle of the two ways.
        const auto side = [&](std::size_t i, double hand) {
            const Vec2d way = ((w.middle[i] - w.middle[i - 1]).normalized() +
                               (w.middle[i + 1] - w.middle[i]).normalized())
                                  .normalized();
            return Vec2d(w.middle[i] + hand * w.thickness / 2 * left_of(way));
        };
        ring.push_back(corner(w, true, -1));
        for (std::size_t i = 1; i + 1 < n; ++i) ring.push_back(side(i, 1));
        ring.push_back(corner(w, false, 1));
        ring.push_back(corner(w, false, -1));
        for (std::size_t i = n - 1; i-- > 1;) ring.push_back(side(i, -1));
        ring.push_back(corner(w, true, 1));
        // A wall shorter than its neighbours are thick may be cut to nothing by its mitres.
        const Vec2d way = w.end(false) - w.end(true);
        const bool forward = (ring[1] - ring[0]).dot(way) > 0 && (ring[3] - ring[2]).dot(way) < 0;
        if (n > 2 || forward) return {ring, {}};
        const Vec2d half = w.thickness / 2 * left_of(way.normalized());
        return {{w.end(true) + half, w.end(false) + half, w.end(false) - half, w.end(true) - half},
                {}};
    }

    void add_room(const pugi::xml_node& node) {
        Polygon room;
        for (const pugi::xml_node& p : node.children("point")) {
            room.outer.emplace_back(document_.number(p, "x"), -document_.number(p, "y"));
        }
        if (room.outer.size() < 3) document_.fail(node, "it has fewer than three points");
        add("room", Role::room, node.attribute("name").value(), {std::move(room)});
    }

    // Doors, windows and furniture, also in groups.
    void add_pieces(const pugi::xml_node& root) {
        std::vector<pugi::xml_node> groups = {root};
        while (!groups.empty()) {
            const pugi::xml_node group = groups.back();
            groups.pop_back();
            for (const pugi::xml_node& piece : group.children()) {
                const std::string_view kind = piece.name();
                if (!on_level(piece)) continue;
                if (kind == "furnitureGroup") groups.push_back(piece);
                if (kind == "doorOrWindow") add_opening(piece);
                if (kind == "pieceOfFurniture") add_furniture(piece);
            }
        }
    }

    struct Piece {
        Vec2d centre;
        Vec2d along;   // its width
        Vec2d across;  // from its front to its back
        double width = 0;
        double depth = 0;

        Polygon rectangle() const {
            const Vec2d w = width / 2 * along;
            const Vec2d d = depth / 2 * across;
            return {{centre - w - d, centre + w - d, centre + w + d, centre - w + d}, {}};
        }
    };
    Piece piece_of(const pugi::xml_node& node) const {
        const double angle = -document_.number(node, "angle", 0);
        Piece p;
        p.centre = {document_.number(node, "x"), -document_.number(node, "y")};
        p.along = {std::cos(angle), std::sin(angle)};
        p.across = left_of(p.along);
        p.width = document_.number(node, "width");
        p.depth = document_.number(node, "depth");
        return p;
    }

    void add_furniture(const pugi::xml_node& node) {
        const std::string text = std::string("furniture ") + node.attribute("name").value();
        if (Feature* f = tally_.add(out_.set, options_, text, {}, text)) {
            f->polygons = {piece_of(node).rectangle()};
        }
    }

    // The stretches that a door takes up of the walls it stands in; without walls its own place.
    void add_opening(const pugi::xml_node& node) {
        Piece p = piece_of(node);
        const double thick = document_.number(node, "wallThickness", 1) * p.depth;
        const double before = document_.number(node, "wallDistance", 0) * p.depth;
        p.centre += (p.depth / 2 - before - thick / 2) * p.across;  // the part in the wall
        p.depth = thick;
        std::vector<Polygon> stretches;
        for (const HomeWall& w : walls_) {
            for (std::size_t i = 1; i < w.middle.size(); ++i) {
                const Vec2d a = w.middle[i - 1];
                const double length = (w.middle[i] - a).norm();
                const Vec2d u = (w.middle[i] - a) / length;
                constexpr double askew = 0.1;  // rad
                if (length == 0 || std::abs(cross(u, p.along)) > askew) continue;
                const double at = (p.centre - a).dot(u);
                const double beside = cross(u, p.centre - a);
                if (std::abs(beside) >= (w.thickness + p.depth) / 2) continue;
                if (at + p.width / 2 <= 0 || at - p.width / 2 >= length) continue;
                Piece stretch = p;
                stretch.along = u;
                stretch.across = left_of(u);
                stretch.centre = a + at * u;
                stretch.depth = w.thickness;
                stretches.push_back(stretch.rectangle());
            }
        }
        if (stretches.empty()) stretches.push_back(p.rectangle());
        const std::string catalogue = node.attribute("catalogId").value();
        const std::string name = node.attribute("name").value();
        const std::string text = name.empty() ? catalogue : name;
        const bool window = role_of_word(catalogue) == Role::window ||
                            (catalogue.empty() && role_of_word(name) == Role::window);
        add(text, window ? Role::window : Role::door, text, std::move(stretches));
    }

    void add(const std::string& text, Role own, const std::string& id, std::vector<Polygon> p) {
        if (Feature* f = tally_.add(out_.set, options_, text, own, id)) f->polygons = std::move(p);
    }

    const XmlDocument& document_;
    const ReadOptions& options_;
    std::string level_;
    std::vector<HomeWall> walls_;
    std::map<std::string, std::size_t> number_of_;
    RoleTally tally_;
    Drawing out_;
};

}  // namespace

Drawing read_sweet_home(const XmlDocument& document, const ReadOptions& options) {
    return Home(document, options).read();
}

}  // namespace vfplan
