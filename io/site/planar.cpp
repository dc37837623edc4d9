#include "io/site/planar.h"

#include <fmt/format.h>
#include <geos_c.h>

#include <algorithm>
#include <memory>

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

Geometry lines_of(const std::vector<Line>& lines) {
    std::vector<GEOSGeometry*> parts;
    for (const Line& line : lines) {
        if (line.size() >= 2) {
            parts.push_back(GEOSGeom_createLineString_r(context(), sequence(line, false)));
        }
    }
    return collection(GEOS_MULTILINESTRING, std::move(parts));
}

std::vector<const Ring*> rings_of(const Polygon& p) {
    std::vector<const Ring*> out = {&p.outer};
    for (const Ring& hole : p.holes) out.push_back(&hole);
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

namespace {

// On a grid, or as exact as doubles are if that is 0.
Geometry united(const std::vector<Polygon>& polygons, double snap_m) {
    std::vector<GEOSGeometry*> parts;
    for (const Polygon& p : polygons) {
        if (p.outer.size() < 3) continue;
        Geometry g = polygon(p);
        if (GEOSisValid_r(context(), g.get()) == 1) {
            parts.push_back(g.release());
            continue;
        }
        // A ring that goes out and back along a line leaves that, which surrounds nothing.
        g = checked(GEOSMakeValid_r(context(), g.get()), "a repair");
        each_part(g.get(), GEOS_POLYGON, [&](const GEOSGeometry* part) {
            parts.push_back(GEOSGeom_clone_r(context(), part));
        });
    }
    const Geometry all = collection(GEOS_GEOMETRYCOLLECTION, std::move(parts));
    return checked(snap_m > 0 ? GEOSUnaryUnionPrec_r(context(), all.get(), snap_m)
                              : GEOSUnaryUnion_r(context(), all.get()),
                   "a union");
}

Geometry without(const Geometry& a, const Geometry& b, double snap_m) {
    return checked(snap_m > 0 ? GEOSDifferencePrec_r(context(), a.get(), b.get(), snap_m)
                              : GEOSDifference_r(context(), a.get(), b.get()),
                   "a difference");
}

double area_m2(const Geometry& g) {
    double area = 0;
    GEOSArea_r(context(), g.get(), &area);
    return area;
}

struct PreparedDestroyer {
    void operator()(const GEOSPreparedGeometry* g) const {
        GEOSPreparedGeom_destroy_r(context(), g);
    }
};
using Prepared = std::unique_ptr<const GEOSPreparedGeometry, PreparedDestroyer>;

bool contains(const Prepared& area, const Vec2d& p) {
    const Geometry point(GEOSGeom_createPointFromXY_r(context(), p.x(), p.y()));
    return GEOSPreparedContains_r(context(), area.get(), point.get()) == 1;
}

}  // namespace

struct Drawn::Impl {
    Geometry solids;
    Geometry outlines;
    Prepared in_solids;
    Prepared in_outlines;
    double snap_m = 0;
    double lines_m = 0;
};

Drawn::Drawn(const Parts& parts, double snap_m) : impl_(std::make_unique<Impl>()) {
    impl_->snap_m = snap_m;
    // Openings end on the faces of walls: rounded one by one they would leave leaves of them.
    const Geometry openings = united(parts.openings, 0);
    if (parts.openings.empty()) {
        impl_->solids = united(parts.solids, snap_m);
    } else {
        const Geometry opened = without(united(parts.solids, 0), openings, 0);
        impl_->solids = checked(GEOSUnaryUnionPrec_r(context(), opened.get(), snap_m), "a union");
    }
    if (!parts.obstacles.empty()) {
        const Geometry obstacles = united(parts.obstacles, snap_m);
        impl_->solids = checked(
            GEOSUnionPrec_r(context(), impl_->solids.get(), obstacles.get(), snap_m), "a union");
    }
    impl_->outlines = united(parts.outlines, snap_m);
    impl_->in_solids.reset(GEOSPrepare_r(context(), impl_->solids.get()));
    impl_->in_outlines.reset(GEOSPrepare_r(context(), impl_->outlines.get()));
    std::vector<Line> lines = parts.lines;
    for (const Polygon& p : parts.outlines) {
        for (const Ring* ring : rings_of(p)) {
            lines.push_back(*ring);
            lines.back().push_back(ring->front());
        }
    }
    if (lines.empty()) return;
    Geometry once = lines_of(lines);
    if (!parts.openings.empty()) once = without(once, openings, 0);
    once = checked(GEOSUnaryUnionPrec_r(context(), once.get(), snap_m), "a union");
    once = without(once, impl_->solids, snap_m);
    GEOSLength_r(context(), once.get(), &impl_->lines_m);
}

Drawn::~Drawn() = default;

double Drawn::border_m() const {
    double border_m = 0;
    GEOSLength_r(context(), impl_->solids.get(), &border_m);
    return border_m;
}
double Drawn::lines_m() const { return impl_->lines_m; }
double Drawn::solid_m2() const { return area_m2(impl_->solids); }
double Drawn::outlined_m2() const {
    return area_m2(without(impl_->outlines, impl_->solids, impl_->snap_m));
}
bool Drawn::has_outlines() const { return area_m2(impl_->outlines) > 0; }
bool Drawn::solid(const Vec2d& p) const { return contains(impl_->in_solids, p); }
bool Drawn::outlined(const Vec2d& p) const { return contains(impl_->in_outlines, p); }

}  // namespace vfplan::planar
