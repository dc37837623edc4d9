#include "io/site/planar.h"

#include <fmt/format.h>
#include <geos_c.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "io/site/groups.h"
#include "kernels/error.h"

namespace vfplan::planar {
namespace {

// One context per thread, so that calls from different threads never meet.
GEOSContextHandle_t context() {
    struct Holder {
        GEOSContextHandle_t handle = GEOS_init_r();
        Holder() = default;
        ~Holder() { GEOS_finish_r(handle); }
        Holder(const Holder&) = delete;
        Holder& operator=(const Holder&) = delete;
    };
    thread_local const Holder holder;
    return holder.handle;
}

struct GeometryDestroyer {
    void operator()(GEOSGeometry* g) const { GEOSGeom_destroy_r(context(), g); }
};
using Geometry = std::unique_ptr<GEOSGeometry, GeometryDestroyer>;

Geometry checked(GEOSGeometry* g, const char* what) {
    if (g == nullptr) {
        throw InputError(
            fmt::format("the geometry library failed in {}; set site.invalid = "
                        "\"repair\" or clean the input",
                        what));
    }
    return Geometry(g);
}

GEOSCoordSequence* sequence(const Line& line, bool close) {
    const auto n = static_cast<unsigned>(line.size() + (close ? 1 : 0));
    GEOSCoordSequence* s = GEOSCoordSeq_create_r(context(), n, 2);
    for (unsigned i = 0; i < n; ++i) {
        const Vec2d& p = line[i % line.size()];
        GEOSCoordSeq_setXY_r(context(), s, i, p.x(), p.y());
    }
    return s;
}

GEOSGeometry* ring(const Ring& points) {
    return GEOSGeom_createLinearRing_r(context(), sequence(points, true));
}

Geometry polygon(const Polygon& p) {
    std::vector<GEOSGeometry*> holes;
    for (const Ring& hole : p.holes) {
        if (hole.size() >= 3) holes.push_back(ring(hole));
    }
    return checked(GEOSGeom_createPolygon_r(context(), ring(p.outer), holes.data(),
                                            static_cast<unsigned>(holes.size())),
                   "a polygon");
}

Geometry collection(int type, std::vector<GEOSGeometry*> parts) {
    return checked(GEOSGeom_createCollection_r(context(), type, parts.data(),
                                               static_cast<unsigned>(parts.size())),
                   "a collection");
}

Geometry polygons_of(const std::vector<Polygon>& polygons) {
    std::vector<GEOSGeometry*> parts;
    for (const Polygon& p : polygons) {
        if (p.outer.size() >= 3) parts.push_back(polygon(p).release());
    }
    return collection(GEOS_MULTIPOLYGON, std::move(parts));
}

Geometry lines_of(const std::vector<Line>& lines) {
    std::vector<GEOSGeometry*> parts;
    for (const Line& line : lines) {
        if (line.size() >= 2) {
            parts.push_back(GEOSGeom_createLineString_r(context(), sequence(line, false)));
        }
    }
    return collection(GEOS_MULTILINESTRING, std::move(parts));
}

Line points_of(const GEOSGeometry* g, bool closed) {
    const GEOSCoordSequence* s = GEOSGeom_getCoordSeq_r(context(), g);
    unsigned n = 0;
    GEOSCoordSeq_getSize_r(context(), s, &n);
    Line out;
    out.reserve(n);
    for (unsigned i = 0; i + (closed ? 1 : 0) < n; ++i) {
        double x = 0;
        double y = 0;
        GEOSCoordSeq_getXY_r(context(), s, i, &x, &y);
        out.emplace_back(x, y);
    }
    return out;
}

// Calls f for every polygon (or line) in a geometry of any nesting.
template <class F>
void each_part(const GEOSGeometry* g, int wanted, F&& f) {
    const int type = GEOSGeomTypeId_r(context(), g);
    if (type == wanted || (wanted == GEOS_LINESTRING && type == GEOS_LINEARRING)) {
        if (GEOSisEmpty_r(context(), g) == 0) f(g);
        return;
    }
    if (type < GEOS_MULTIPOINT) return;
    for (int i = 0; i < GEOSGetNumGeometries_r(context(), g); ++i) {
        each_part(GEOSGetGeometryN_r(context(), g, i), wanted, f);
    }
}

std::vector<Polygon> polygons_in(const Geometry& g) {
    GEOSNormalize_r(context(), g.get());  // one order and one start, whatever GEOS did
    std::vector<Polygon> out;
    each_part(g.get(), GEOS_POLYGON, [&](const GEOSGeometry* part) {
        Polygon p;
        p.outer = points_of(GEOSGetExteriorRing_r(context(), part), true);
        for (int i = 0; i < GEOSGetNumInteriorRings_r(context(), part); ++i) {
            p.holes.push_back(points_of(GEOSGetInteriorRingN_r(context(), part, i), true));
        }
        out.push_back(std::move(p));
    });
    return out;
}

std::vector<Line> lines_in(const Geometry& g) {
    GEOSNormalize_r(context(), g.get());
    std::vector<Line> out;
    each_part(g.get(), GEOS_LINESTRING,
              [&](const GEOSGeometry* part) { out.push_back(points_of(part, false)); });
    return out;
}

}  // namespace

std::string invalid_reason(const Polygon& p) {
    if (p.outer.size() < 3) return "fewer than three points";
    const Geometry g = polygon(p);
    char* reason = nullptr;
    GEOSGeometry* where = nullptr;
    const char valid = GEOSisValidDetail_r(context(), g.get(), 0, &reason, &where);
    std::string out;
    if (valid != 1) {
        out = reason == nullptr ? "invalid" : reason;
        if (where != nullptr) {
            double x = 0;
            double y = 0;
            GEOSGeomGetX_r(context(), where, &x);
            GEOSGeomGetY_r(context(), where, &y);
            out += fmt::format(" at ({:.3f}, {:.3f})", x, y);
        }
    }
    if (reason != nullptr) GEOSFree_r(context(), reason);
    if (where != nullptr) GEOSGeom_destroy_r(context(), where);
    return out;
}

std::vector<Polygon> repaired(const Polygon& p) {
    if (p.outer.size() < 3) return {};
    return polygons_in(checked(GEOSMakeValid_r(context(), polygon(p).get()), "a repair"));
}

namespace {

// The polygon with its points on the grid, when that is all there is to do: nothing of it comes so
// near to itself that rounding could make it touch. Null otherwise.
Geometry rounded(const Polygon& p, double snap_m) {
    const auto round = [&](const Ring& in) {
        Ring out;
        for (const Vec2d& v : in) {
            const Vec2d w(std::round(v.x() / snap_m) * snap_m, std::round(v.y() / snap_m) * snap_m);
            if (out.empty() || w != out.back()) out.push_back(w);
        }
        while (out.size() > 1 && out.back() == out.front()) out.pop_back();
        return out;
    };
    Polygon on_grid;
    on_grid.outer = round(p.outer);
    if (on_grid.outer.size() < 3) return nullptr;
    for (const Ring& hole : p.holes) {
        on_grid.holes.push_back(round(hole));
        if (on_grid.holes.back().size() < 3) return nullptr;
    }
    Geometry g = polygon(on_grid);
    double clearance_m = 0;
    if (GEOSisValid_r(context(), g.get()) != 1 ||
        GEOSMinimumClearance_r(context(), g.get(), &clearance_m) != 0 || clearance_m < 2 * snap_m) {
        return nullptr;
    }
    return g;
}

}  // namespace

Box bounds(const Line& points) {
    Box box;
    for (const Vec2d& v : points) box.add(v);
    return box;
}

// Group by group: one union of everything would node all that is there again and again.
std::vector<Polygon> unite(const std::vector<Polygon>& polygons, double snap_m) {
    if (polygons.empty()) return {};
    std::vector<Geometry> parts;
    std::vector<Box> boxes;
    for (const Polygon& p : polygons) boxes.push_back(bounds(p.outer));
    for (const std::vector<std::size_t>& group : neighbour_groups(boxes, 4 * snap_m)) {
        if (group.size() == 1) {
            if (Geometry alone = rounded(polygons[group.front()], snap_m)) {
                parts.push_back(std::move(alone));
                continue;
            }
        }
        std::vector<Polygon> members;
        for (const std::size_t i : group) members.push_back(polygons[i]);
        const Geometry united =
            checked(GEOSUnaryUnionPrec_r(context(), polygons_of(members).get(), snap_m), "a union");
        // A union of one polygon comes back as it was, off the grid.
        parts.push_back(
            checked(GEOSGeom_setPrecision_r(context(), united.get(), snap_m, 0), "snapping"));
    }
    std::vector<GEOSGeometry*> released;
    for (Geometry& part : parts) released.push_back(part.release());
    return polygons_in(collection(GEOS_GEOMETRYCOLLECTION, std::move(released)));
}

std::vector<Polygon> subtract(const std::vector<Polygon>& from, const std::vector<Polygon>& what,
                              double snap_m) {
    if (from.empty() || what.empty()) return from;
    return polygons_in(
        checked(GEOSDifferencePrec_r(context(), polygons_of(unite(from, snap_m)).get(),
                                     polygons_of(unite(what, snap_m)).get(), snap_m),
                "a difference"));
}

std::vector<Polygon> intersect(const std::vector<Polygon>& a, const std::vector<Polygon>& b,
                               double snap_m) {
    if (a.empty() || b.empty()) return {};
    return polygons_in(
        checked(GEOSIntersectionPrec_r(context(), polygons_of(unite(a, snap_m)).get(),
                                       polygons_of(unite(b, snap_m)).get(), snap_m),
                "an intersection"));
}

std::vector<Polygon> grow(const std::vector<Polygon>& polygons, double distance_m) {
    if (polygons.empty()) return {};
    return polygons_in(
        checked(GEOSBufferWithStyle_r(context(), polygons_of(polygons).get(), distance_m, 4,
                                      GEOSBUF_CAP_SQUARE, GEOSBUF_JOIN_MITRE, 2.0),
                "a buffer"));
}

std::vector<Polygon> strips(const std::vector<Line>& lines, double distance_m, bool flat) {
    if (lines.empty()) return {};
    return polygons_in(checked(
        GEOSBufferWithStyle_r(context(), lines_of(lines).get(), distance_m, 8,
                              flat ? GEOSBUF_CAP_FLAT : GEOSBUF_CAP_ROUND, GEOSBUF_JOIN_ROUND, 2.0),
        "a buffer"));
}

std::vector<Line> node(const std::vector<Line>& lines, double snap_m) {
    // Edge by edge: GEOS leaves a line that is alone as it was, crossings with itself and all.
    std::vector<Line> edges;
    for (const Line& line : lines) {
        for (std::size_t i = 1; i < line.size(); ++i) edges.push_back({line[i - 1], line[i]});
    }
    if (edges.empty()) return {};
    return lines_in(
        checked(GEOSUnaryUnionPrec_r(context(), lines_of(edges).get(), snap_m), "noding"));
}

double inscribed_radius(const std::vector<Line>& border, double tolerance) {
    const Geometry area =
        checked(GEOSBuildArea_r(context(), lines_of(border).get()), "building an area");
    double largest = 0;
    each_part(area.get(), GEOS_POLYGON, [&](const GEOSGeometry* part) {
        const Geometry circle =
            checked(GEOSMaximumInscribedCircle_r(context(), part, tolerance), "a circle");
        double radius = 0;
        GEOSLength_r(context(), circle.get(), &radius);
        largest = std::max(largest, radius);
    });
    return largest;
}

double area_m2(const std::vector<Polygon>& polygons) {
    double area = 0;
    if (!polygons.empty()) GEOSArea_r(context(), polygons_of(polygons).get(), &area);
    return area;
}

struct Region::Impl {
    Geometry geometry;
    const GEOSPreparedGeometry* prepared = nullptr;
};

Region::Region(const std::vector<Polygon>& polygons) : impl_(new Impl{polygons_of(polygons)}) {
    impl_->prepared = GEOSPrepare_r(context(), impl_->geometry.get());
}

Region::~Region() {
    GEOSPreparedGeom_destroy_r(context(), impl_->prepared);
    delete impl_;
}

bool Region::contains(const Vec2d& p) const {
    const Geometry point(GEOSGeom_createPointFromXY_r(context(), p.x(), p.y()));
    return GEOSPreparedContains_r(context(), impl_->prepared, point.get()) == 1;
}

struct LineIndex::Impl {
    std::vector<Line> lines;
    std::vector<std::size_t> number;
    std::vector<Geometry> boxes;
    GEOSSTRtree* tree = nullptr;
};

LineIndex::LineIndex(const std::vector<Line>& lines) : impl_(new Impl{lines, {}, {}}) {
    impl_->tree = GEOSSTRtree_create_r(context(), 8);
    impl_->number.resize(lines.size());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        impl_->number[i] = i;
        impl_->boxes.push_back(
            Geometry(GEOSGeom_createLineString_r(context(), sequence(lines[i], false))));
        GEOSSTRtree_insert_r(context(), impl_->tree, impl_->boxes.back().get(), &impl_->number[i]);
    }
}

LineIndex::~LineIndex() {
    GEOSSTRtree_destroy_r(context(), impl_->tree);
    delete impl_;
}

std::vector<std::size_t> LineIndex::near(const Vec2d& p, double distance_m) const {
    const Vec2d d(distance_m, distance_m);
    const Geometry box(GEOSGeom_createLineString_r(context(), sequence({p - d, p + d}, false)));
    std::vector<std::size_t> hits;
    GEOSSTRtree_query_r(
        context(), impl_->tree, box.get(),
        [](void* item, void* list) {
            static_cast<std::vector<std::size_t>*>(list)->push_back(
                *static_cast<std::size_t*>(item));
        },
        &hits);
    std::erase_if(hits, [&](std::size_t i) {
        const Line& line = impl_->lines[i];
        for (std::size_t k = 1; k < line.size(); ++k) {
            const Vec2d e = line[k] - line[k - 1];
            const double t = e.squaredNorm() > 0
                                 ? std::clamp((p - line[k - 1]).dot(e) / e.squaredNorm(), 0.0, 1.0)
                                 : 0.0;
            if ((line[k - 1] + e * t - p).norm() <= distance_m) return false;
        }
        return true;
    });
    std::sort(hits.begin(), hits.end());
    return hits;
}

}  // namespace vfplan::planar
