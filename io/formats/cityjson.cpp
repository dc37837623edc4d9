#include "io/formats/cityjson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>

#include "io/features/role_tally.h"
#include "io/formats/rings.h"

namespace vfplan {
namespace {

struct Surface {
    std::vector<Corners> rings;
    bool ground = false;  // by its semantics
};

class City {
public:
    explicit City(const JsonAt& root) : root_(root) {
        Vec2d scale(1, 1);
        Vec2d move(0, 0);
        if (root.has("transform")) {
            const JsonAt t = root["transform"];
            scale = {t["scale"].at(0).number(), t["scale"].at(1).number()};
            move = {t["translate"].at(0).number(), t["translate"].at(1).number()};
        }
        const JsonAt vertices = root["vertices"];
        places_.reserve(vertices.size());
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            const JsonAt v = vertices.at(i);
            places_.emplace_back(v.at(0).number() * scale.x() + move.x(),
                                 v.at(1).number() * scale.y() + move.y());
        }
    }

    std::vector<Polygon> footprint(const JsonAt& object) const {
        std::vector<Surface> surfaces;
        if (object.has("geometry")) {
            const JsonAt geometries = object["geometry"];
            std::size_t best = 0;
            double best_lod = -1;
            for (std::size_t i = 0; i < geometries.size(); ++i) {
                if (!geometries.at(i).has("boundaries")) continue;  // an instance of a template
                if (lod(geometries.at(i)) <= best_lod) continue;
                best = i;
                best_lod = lod(geometries.at(i));
            }
            if (best_lod >= 0) surfaces = surfaces_of(geometries.at(best));
        }
        const bool named = std::any_of(surfaces.begin(), surfaces.end(),
                                       [](const Surface& s) { return s.ground; });
        const auto with = [&](auto&& wanted) {
            std::vector<std::vector<Corners>> out;
            for (const Surface& s : surfaces) {
                if (wanted(s)) out.push_back(s.rings);
            }
            return united(out, places_);
        };
        if (named) return with([](const Surface& s) { return s.ground; });
        const auto down = with([&](const Surface& s) { return !upright(s) && area(s) < 0; });
        return down.empty() ? with([&](const Surface& s) { return !upright(s); }) : down;
    }

private:
    static double lod(const JsonAt& geometry) {
        if (!geometry.has("lod")) return 0;
        const JsonAt l = geometry["lod"];
        return l.value().is_string() ? std::strtod(l.text().c_str(), nullptr) : l.number();
    }

    // Twice the area of the outer ring from above: negative where the surface looks down.
    double area(const Surface& s) const {
        double sum = 0;
        each_corner(s, [&](double turn) { sum += turn; });
        return sum;
    }
    // From above it is a line.
    bool upright(const Surface& s) const {
        constexpr double flat_m2 = 1e-6;
        double most = 0;
        each_corner(s, [&](double turn) { most = std::max(most, std::abs(turn)); });
        return most < flat_m2;
    }
    template <class F>
    void each_corner(const Surface& s, F&& f) const {
        const Corners& ring = s.rings.front();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            f(cross(places_[ring[i]] - places_[ring[0]],
                    places_[ring[(i + 1) % ring.size()]] - places_[ring[0]]));
        }
    }

    std::vector<Surface> surfaces_of(const JsonAt& geometry) const {
        const std::string type = geometry["type"].text();
        const std::map<std::string, int> lists_around = {{"MultiSurface", 0},
                                                         {"CompositeSurface", 0},
                                                         {"Solid", 1},
                                                         {"MultiSolid", 2},
                                                         {"CompositeSolid", 2}};
        const auto known = lists_around.find(type);
        std::vector<Surface> out;
        if (known == lists_around.end()) return out;  // points and lines are no buildings
        const bool semantics = geometry.has("semantics") && geometry["semantics"].has("values") &&
                               geometry["semantics"].has("surfaces");
        collect(geometry["boundaries"], known->second, geometry, semantics, {}, out);
        return out;
    }

    // Surfaces below a list; `path` leads to it from the geometry's boundaries.
    void collect(const JsonAt& at, int lists_around, const JsonAt& geometry, bool semantics,
                 const std::vector<std::size_t>& path, std::vector<Surface>& out) const {
        for (std::size_t i = 0; i < at.size(); ++i) {
            std::vector<std::size_t> to = path;
            to.push_back(i);
            if (lists_around > 0) {
                collect(at.at(i), lists_around - 1, geometry, semantics, to, out);
                continue;
            }
            Surface s;
            for (std::size_t r = 0; r < at.at(i).size(); ++r) {
                const JsonAt ring = at.at(i).at(r);
                Corners corners;
                for (std::size_t k = 0; k < ring.size(); ++k) {
                    corners.push_back(ring.at(k).index(places_.size()));
                }
                if (corners.size() > 2) s.rings.push_back(std::move(corners));
            }
            s.ground = semantics && is_ground(geometry["semantics"], to);
            if (!s.rings.empty()) out.push_back(std::move(s));
        }
    }
    static bool is_ground(const JsonAt& semantics, const std::vector<std::size_t>& path) {
        const nlohmann::json* v = &semantics.value()["values"];
        for (const std::size_t i : path) {
            if (!v->is_array() || i >= v->size()) return false;
            v = &(*v)[i];
        }
        const nlohmann::json& surfaces = semantics.value()["surfaces"];
        if (!v->is_number_unsigned() || v->get<std::size_t>() >= surfaces.size()) return false;
        return surfaces[v->get<std::size_t>()].value("type", "") == "GroundSurface";
    }

    const JsonAt& root_;
    std::vector<Vec2d> places_;
};

// "https://www.opengis.net/def/crs/EPSG/0/7415" and "urn:ogc:def:crs:EPSG::7415" alike.
std::string epsg_of(const std::string& reference) {
    const auto at = reference.find("EPSG");
    const auto digit = reference.find_last_not_of("0123456789");
    if (at == std::string::npos || digit == std::string::npos || digit + 1 >= reference.size()) {
        return "";
    }
    return fmt::format("EPSG:{}", reference.substr(digit + 1));
}

}  // namespace

Drawing read_cityjson(const JsonAt& root, const ReadOptions& options) {
    const City city(root);
    Drawing out;
    RoleTally tally;
    out.set.how.format =
        fmt::format("CityJSON {}", root.has("version") ? root["version"].text() : "");
    if (root.has("metadata") && root["metadata"].has("referenceSystem")) {
        const std::string said = root["metadata"]["referenceSystem"].text();
        out.crs.wkt = wkt_of_code(epsg_of(said));
        if (out.crs.wkt.empty()) {
            out.set.warnings.push_back(
                fmt::format("no coordinate reference system is known by '{:.80}'", said));
        }
    }
    const JsonAt objects = root["CityObjects"];
    std::int64_t number = 0;
    for (const auto& [id, ignored] : objects.value().items()) {
        const JsonAt object = objects[id.c_str()];
        ++number;
        const std::string type = object["type"].text();
        const bool building = type == "Building" || type == "BuildingPart";
        const auto role =
            tally.settle(options, type, building ? std::optional(Role::building) : std::nullopt);
        if (!role) continue;
        Feature f;
        f.number = number;
        f.id = id;
        f.role = *role;
        f.polygons = city.footprint(object);
        if (f.polygons.empty()) continue;  // its parts have it
        out.set.features.push_back(std::move(f));
    }
    tally.add_to(out.set, "");
    return out;
}

}  // namespace vfplan
