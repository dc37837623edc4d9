#include "bench/peers/cgal_expansion.h"

#include <CGAL/Arr_segment_traits_2.h>
#include <CGAL/Arr_triangulation_point_location.h>
#include <CGAL/Arrangement_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Triangular_expansion_visibility_2.h>

#include <stdexcept>

#include "kernels/angle.h"

namespace vfplan::peers {
namespace {

using K = CGAL::Exact_predicates_exact_constructions_kernel;
using Arrangement = CGAL::Arrangement_2<CGAL::Arr_segment_traits_2<K>>;
using Expansion = CGAL::Triangular_expansion_visibility_2<Arrangement, CGAL::Tag_true>;

K::Point_2 point(const Vec2d& p) { return {p.x(), p.y()}; }
Vec2d vec(const K::Point_2& p) { return {CGAL::to_double(p.x()), CGAL::to_double(p.y())}; }

}  // namespace

// Walls in a large square, so that every face is bounded.
struct CgalExpansion::Impl {
    Vec2d lo;
    Vec2d hi;
    Arrangement arrangement;
    CGAL::Arr_triangulation_point_location<Arrangement> location;
    Expansion expansion;

    void see(const Vec2d& eye, Arrangement& seen) const {
        const auto where = location.locate(point(eye));
        const auto* face = boost::get<Arrangement::Face_const_handle>(&where);
        if (face == nullptr) throw std::invalid_argument("the eye stands on a wall");
        expansion.compute_visibility(point(eye), *face, seen);
    }

    bool on_square(const K::Point_2& p, const K::Point_2& q) const {  // exactly
        return (p.x() == lo.x() && q.x() == lo.x()) || (p.x() == hi.x() && q.x() == hi.x()) ||
               (p.y() == lo.y() && q.y() == lo.y()) || (p.y() == hi.y() && q.y() == hi.y());
    }
};

CgalExpansion::CgalExpansion(const std::vector<Wall>& walls, const Box& around)
    : impl_(std::make_unique<Impl>()) {
    const double margin = 3 * around.size().norm();
    impl_->lo = around.min - Vec2d(margin, margin);
    impl_->hi = around.max + Vec2d(margin, margin);
    const Vec2d corner[] = {
        impl_->lo, {impl_->hi.x(), impl_->lo.y()}, impl_->hi, {impl_->lo.x(), impl_->hi.y()}};
    std::vector<K::Segment_2> segments;
    for (const Wall& w : walls) segments.emplace_back(point(w.a), point(w.b));
    for (int i = 0; i < 4; ++i) segments.emplace_back(point(corner[i]), point(corner[(i + 1) % 4]));
    CGAL::insert_non_intersecting_curves(impl_->arrangement, segments.begin(), segments.end());
    impl_->location.attach(impl_->arrangement);
    impl_->expansion.attach(impl_->arrangement);
}

CgalExpansion::~CgalExpansion() = default;

// 2 pi less the angle through which the square shows.
double CgalExpansion::vf_rad(const Vec2d& eye) const {
    Arrangement seen;
    impl_->see(eye, seen);
    double outside = 0;
    for (auto e = seen.edges_begin(); e != seen.edges_end(); ++e) {
        const K::Point_2& p = e->source()->point();
        const K::Point_2& q = e->target()->point();
        if (!impl_->on_square(p, q)) continue;
        const double a = angle_between_rad(vec(p) - eye, vec(q) - eye);
        outside += std::min(a, 2 * pi - a);
    }
    return 2 * pi - outside;
}

std::size_t CgalExpansion::corners(const Vec2d& eye) const {
    Arrangement seen;
    impl_->see(eye, seen);
    std::size_t count = 0;
    for (auto v = seen.vertices_begin(); v != seen.vertices_end(); ++v) {
        const Vec2d p = vec(v->point());
        if (p.x() == p.x() && p.y() == p.y()) ++count;
    }
    return count;
}

}  // namespace vfplan::peers
