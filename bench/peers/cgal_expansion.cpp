#include "bench/peers/cgal_expansion.h"

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arr_triangulation_point_location.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangular_expansion_visibility_2.h>

#include <stdexcept>

#include "kernels/view.h"

namespace vfplan::peers {
namespace {

using K = CGAL::Exact_predicates_exact_constructions_kernel;
using Arrangement = CGAL::Arrangement_2<CGAL::Arr_segment_traits_2<K>>;
using Expansion = CGAL::Triangular_expansion_visibility_2<Arrangement, CGAL::Tag_true>;

K::Point_2 point(const Vec2d& p) { return {p.x(), p.y()}; }

}  // namespace

struct CgalExpansion::Impl {
    Arrangement arrangement;
    CGAL::Arr_triangulation_point_location<Arrangement> location;
    Expansion expansion;
    Arrangement::Face_const_handle face;
};

// Walls in a large square, so that every face is bounded.
CgalExpansion::CgalExpansion(const std::vector<Wall>& walls, const Box& around)
    : impl_(std::make_unique<Impl>()) {
    const double margin = 3 * around.size().norm();
    const Vec2d lo = around.min - Vec2d(margin, margin);
    const Vec2d hi = around.max + Vec2d(margin, margin);
    const Vec2d corner[] = {lo, {hi.x(), lo.y()}, hi, {lo.x(), hi.y()}};
    std::vector<K::Segment_2> segments;
    for (const Wall& w : walls) segments.emplace_back(point(w.a), point(w.b));
    for (int i = 0; i < 4; ++i) segments.emplace_back(point(corner[i]), point(corner[(i + 1) % 4]));
    CGAL::insert_non_intersecting_curves(impl_->arrangement, segments.begin(), segments.end());
    impl_->location.attach(impl_->arrangement);
    impl_->expansion.attach(impl_->arrangement);
}

CgalExpansion::~CgalExpansion() = default;

void CgalExpansion::stand_at(const Vec2d& eye) {
    const auto where = impl_->location.locate(point(eye));
    const auto* face = boost::get<Arrangement::Face_const_handle>(&where);
    if (face == nullptr) throw std::invalid_argument("the eye stands on a wall");
    impl_->face = *face;
}

void CgalExpansion::see(const Vec2d& eye, std::vector<Vec2d>& corners) const {
    Arrangement seen;
    const auto face = impl_->expansion.compute_visibility(point(eye), impl_->face, seen);
    corners.clear();
    const auto begin = face->outer_ccb();
    auto edge = begin;
    do {
        const K::Point_2& p = edge->source()->point();
        corners.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()));
    } while (++edge != begin);
}

// Edges between two walls point at the eye and have no angle; the square is out of range.
double CgalExpansion::vf_rad(const Vec2d& eye, const Scanner& scanner) const {
    std::vector<Vec2d> corners;
    see(eye, corners);
    const double tan_limit = tan_incidence(scanner);
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        Wall edge;
        edge.a = corners[i];
        edge.b = corners[(i + 1) % corners.size()];
        sum += observed_angle_rad(edge, scanner, tan_limit, eye, edge.a - eye, edge.b - eye);
    }
    return sum;
}

}  // namespace vfplan::peers
