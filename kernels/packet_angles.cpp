// Compiled once per instruction set (Highway's foreach_target); the best one is chosen at run
// time. Each lane does plain IEEE arithmetic without fused multiply-add, so all give the same bits.
#include "kernels/packet_angles.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "kernels/angle.h"
#include "kernels/index.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/packet_angles.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef VFPLAN_PACKET_ANGLES_ONCE
#define VFPLAN_PACKET_ANGLES_ONCE
namespace vfplan {

// The angle of an unbroken run of walls from direction `start` to `end`. `turned`: the run passed
// a direction more than a right angle from its start, which tells no turn from a whole one.
inline double run_angle_rad(const Vec2d& start, const Vec2d& end, bool turned) {
    const double c = cross(start, end);
    const double d = start.dot(end);
    if (d > 0 && turned == (c >= 0)) return c >= 0 ? 2 * pi : 0;
    return c >= 0 ? angle_upper_rad(c, d) : 2 * pi - angle_upper_rad(-c, d);
}

}  // namespace vfplan
#endif

HWY_BEFORE_NAMESPACE();
namespace vfplan {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

constexpr std::size_t most_lanes = HWY_MAX_BYTES / sizeof(double);

inline V cross_lanes(V ux, V uy, V vx, V vy) { return hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx)); }
inline V dot_lanes(V ux, V uy, V vx, V vy) { return hn::Add(hn::Mul(ux, vx), hn::Mul(uy, vy)); }

inline M no_lanes() { return hn::MaskFromVec(hn::Zero(D())); }
inline std::uint32_t bits_of(M m) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), m, bytes);
    return bytes[0];
}
inline M mask_of(std::uint32_t bits) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(bits)};
    return hn::LoadMaskBits(D(), bytes);
}

// Sums the angles of unbroken runs of observed walls, lane by lane.
class Runs {
public:
    explicit Runs(double* vf) : vf_(vf) {}

    void extend(M m, V rx, V ry, V lx, V ly) {
        const M fresh = hn::AndNot(open_, m);
        sx_ = hn::IfThenElse(fresh, rx, sx_);
        sy_ = hn::IfThenElse(fresh, ry, sy_);
        ex_ = hn::IfThenElse(m, lx, ex_);
        ey_ = hn::IfThenElse(m, ly, ey_);
        open_ = hn::Or(open_, m);
        const M behind = hn::Lt(dot_lanes(sx_, sy_, lx, ly), hn::Zero(D()));
        turned_ = hn::Or(hn::AndNot(fresh, turned_), hn::And(m, behind));
    }

    // These lanes see no more of this run.
    void end(M m) {
        broken_ = hn::Or(broken_, m);
        const M closing = hn::And(open_, m);
        if (hn::AllFalse(D(), closing)) return;
        open_ = hn::AndNot(closing, open_);
        close(bits_of(closing), bits_of(turned_));
    }

    void finish() {
        const std::uint32_t open = bits_of(open_);
        const std::uint32_t broken = bits_of(broken_);
        for (std::uint32_t b = open & ~broken; b != 0; b &= b - 1)
            vf_[std::countr_zero(b)] = 2 * pi;
        close(open & broken, bits_of(turned_));
    }

private:
    void close(std::uint32_t lanes, std::uint32_t turned) {
        HWY_ALIGN double sx[most_lanes];
        HWY_ALIGN double sy[most_lanes];
        HWY_ALIGN double ex[most_lanes];
        HWY_ALIGN double ey[most_lanes];
        hn::Store(sx_, D(), sx);
        hn::Store(sy_, D(), sy);
        hn::Store(ex_, D(), ex);
        hn::Store(ey_, D(), ey);
        for (; lanes != 0; lanes &= lanes - 1) {
            const int i = std::countr_zero(lanes);
            vf_[i] += run_angle_rad({sx[i], sy[i]}, {ex[i], ey[i]}, (turned >> i & 1) != 0);
        }
    }

    double* vf_;
    V sx_ = hn::Zero(D()), sy_ = hn::Zero(D()), ex_ = hn::Zero(D()), ey_ = hn::Zero(D());
    M open_ = no_lanes(), broken_ = no_lanes(), turned_ = no_lanes();
};

void one_packet(const Expansion& expansion, const std::vector<Wall>& walls, const Scanner& scanner,
                double tan_incidence, std::int32_t triangle, const double* eyes_x,
                const double* eyes_y, std::size_t count, double* vf_rad, PacketStack& stack,
                FieldCounts& counts) {
    const D d;
    const std::size_t n = hn::Lanes(d);
    HWY_ALIGN double x[most_lanes];
    HWY_ALIGN double y[most_lanes];
    HWY_ALIGN double vf[most_lanes] = {};
    for (std::size_t i = 0; i < n; ++i) {
        x[i] = eyes_x[std::min(i, count - 1)];
        y[i] = eyes_y[std::min(i, count - 1)];
    }
    const auto [x_lo, x_hi] = std::minmax_element(x, x + n);
    const auto [y_lo, y_hi] = std::minmax_element(y, y + n);
    const double mid_x = (*x_lo + *x_hi) / 2;
    const double mid_y = (*y_lo + *y_hi) / 2;
    // Farther than this from the middle, an edge is out of every eye's range.
    const double reach =
        (scanner.range_max_m + std::hypot(*x_hi - *x_lo, *y_hi - *y_lo)) * 1.000001;
    const double reach2 = reach * reach;

    const V ex = hn::Load(d, x);
    const V ey = hn::Load(d, y);
    const V max2 = hn::Set(d, scanner.range_max_m * scanner.range_max_m);
    const double min2 = scanner.range_min_m * scanner.range_min_m;
    const V zero = hn::Zero(d);
    Runs runs(vf);

    std::size_t top = 0;
    const auto push = [&](const PacketStack::Cone& cone, V rx, V ry, V lx, V ly) HWY_ATTR {
        if (top == stack.cones.size()) {
            stack.cones.resize(2 * top + 64);
            stack.borders.resize(4 * most_lanes * stack.cones.size());
        }
        stack.cones[top] = cone;
        double* borders = stack.borders.data() + 4 * n * top;
        hn::StoreU(rx, d, borders);
        hn::StoreU(ry, d, borders + n);
        hn::StoreU(lx, d, borders + 2 * n);
        hn::StoreU(ly, d, borders + 3 * n);
        ++top;
    };
    const auto out_of_reach = [&](const PacketStack::Cone& c) {
        const double r2 = c.right_x * c.right_x + c.right_y * c.right_y;
        if (r2 <= reach2) return false;
        const double l2 = c.left_x * c.left_x + c.left_y * c.left_y;
        if (l2 <= reach2) return false;
        const double e_x = c.left_x - c.right_x;
        const double e_y = c.left_y - c.right_y;
        const double e2 = e_x * e_x + e_y * e_y;
        const double t = -(c.right_x * e_x + c.right_y * e_y);
        if (t <= 0 || t >= e2) return true;
        const double area = c.right_x * e_y - c.right_y * e_x;
        return area * area > reach2 * e2;
    };
    const auto meet = [&](const Wall& wall, M m, V rx, V ry, V lx, V ly) HWY_ATTR {
        if (!wall.scanned) {
            runs.end(m);
            return;
        }
        const V ax = hn::Sub(hn::Set(d, wall.a.x()), ex);
        const V ay = hn::Sub(hn::Set(d, wall.a.y()), ey);
        const V bx = hn::Sub(hn::Set(d, wall.b.x()), ex);
        const V by = hn::Sub(hn::Set(d, wall.b.y()), ey);
        const V area = cross_lanes(ax, ay, bx, by);
        const double len_x = wall.b.x() - wall.a.x();
        const double len_y = wall.b.y() - wall.a.y();
        const double len2 = len_x * len_x + len_y * len_y;
        const V area2 = hn::Mul(area, area);
        const M a_near = hn::Le(dot_lanes(ax, ay, ax, ay), max2);
        const M b_near = hn::Le(dot_lanes(bx, by, bx, by), max2);
        M whole = hn::And(hn::And(a_near, b_near), hn::Ge(area2, hn::Set(d, min2 * len2)));
        if (tan_incidence >= 0) whole = no_lanes();
        const M in_range = hn::And(m, whole);
        const M in_part = hn::AndNot(whole, m);
        if (!hn::AllFalse(d, in_range)) runs.extend(in_range, rx, ry, lx, ly);
        if (hn::AllFalse(d, in_part)) return;
        runs.end(in_part);
        // Out of range where both ends are, and the foot of the perpendicular is too or lies off
        // the wall.
        const V ux = hn::Set(d, len_x);
        const V uy = hn::Set(d, len_y);
        const M foot_far = hn::Or(hn::Ge(area2, hn::Mul(max2, hn::Set(d, len2))),
                                  hn::Or(hn::Ge(dot_lanes(ax, ay, ux, uy), zero),
                                         hn::Le(dot_lanes(bx, by, ux, uy), zero)));
        const M cut = hn::AndNot(hn::AndNot(hn::Or(a_near, b_near), foot_far), in_part);
        if (hn::AllFalse(d, cut)) return;
        HWY_ALIGN double border[4][most_lanes];
        hn::Store(rx, d, border[0]);
        hn::Store(ry, d, border[1]);
        hn::Store(lx, d, border[2]);
        hn::Store(ly, d, border[3]);
        for (std::uint32_t b = bits_of(cut); b != 0; b &= b - 1) {
            const int i = std::countr_zero(b);
            vf[i] += observed_angle_rad(wall, scanner, tan_incidence, {x[i], y[i]},
                                        {border[0][i], border[1][i]}, {border[2][i], border[3][i]});
        }
    };

    const Triangle& start = expansion.mesh.triangles[idx(triangle)];
    const auto all = static_cast<std::uint32_t>((1U << count) - 1);
    for (std::size_t i = 3; i-- > 0;) {
        const Vec2d& r = expansion.mesh.vertices[idx(start.vertex[(i + 1) % 3])];
        const Vec2d& l = expansion.mesh.vertices[idx(start.vertex[(i + 2) % 3])];
        push({expansion.behind(triangle, i), all, r.x() - mid_x, r.y() - mid_y, l.x() - mid_x,
              l.y() - mid_y},
             hn::Sub(hn::Set(d, r.x()), ex), hn::Sub(hn::Set(d, r.y()), ey),
             hn::Sub(hn::Set(d, l.x()), ex), hn::Sub(hn::Set(d, l.y()), ey));
    }
    while (top > 0) {
        --top;
        PacketStack::Cone cone = stack.cones[top];
        const double* borders = stack.borders.data() + 4 * n * top;
        V rx = hn::LoadU(d, borders);
        V ry = hn::LoadU(d, borders + n);
        V lx = hn::LoadU(d, borders + 2 * n);
        V ly = hn::LoadU(d, borders + 3 * n);
        M m = mask_of(cone.lanes);
        while (true) {
            if (is_wall(cone.behind)) {
                ++counts.walls;
                meet(walls[idx(wall_of(cone.behind))], m, rx, ry, lx, ly);
                break;
            }
            if (cone.behind == behind_hull || out_of_reach(cone)) {
                runs.end(m);
                break;
            }
            ++counts.steps;
            const Crossing& c = expansion.crossings[idx(cone.behind)];
            const V ax = hn::Sub(hn::Set(d, c.apex_x), ex);
            const V ay = hn::Sub(hn::Set(d, c.apex_y), ey);
            const M opens_right = hn::And(m, hn::Gt(cross_lanes(rx, ry, ax, ay), zero));
            const M opens_left = hn::And(m, hn::Gt(cross_lanes(ax, ay, lx, ly), zero));
            const double apex_x = c.apex_x - mid_x;
            const double apex_y = c.apex_y - mid_y;
            const bool goes_left = !hn::AllFalse(d, opens_left);
            if (!hn::AllFalse(d, opens_right)) {
                if (goes_left) {
                    push({c.left, bits_of(opens_left), apex_x, apex_y, cone.left_x, cone.left_y},
                         hn::IfThenElse(opens_right, ax, rx), hn::IfThenElse(opens_right, ay, ry),
                         lx, ly);
                    lx = hn::IfThenElse(opens_left, ax, lx);
                    ly = hn::IfThenElse(opens_left, ay, ly);
                }
                cone.behind = c.right;
                cone.left_x = apex_x;
                cone.left_y = apex_y;
                m = opens_right;
            } else if (goes_left) {
                cone.behind = c.left;
                cone.right_x = apex_x;
                cone.right_y = apex_y;
                m = opens_left;
            } else {
                break;
            }
        }
    }
    runs.finish();
    std::copy_n(vf, count, vf_rad);
    ++counts.packets;
    counts.cells += static_cast<std::int64_t>(count);
}

void all_packets(const Expansion& expansion, const std::vector<Wall>& walls, const Scanner& scanner,
                 std::int32_t triangle, const double* x, const double* y, std::size_t count,
                 double* vf_rad, PacketStack& stack, FieldCounts& counts) {
    const std::size_t n = hn::Lanes(D());
    const double tan_limit = tan_incidence(scanner);
    for (std::size_t i = 0; i < count; i += n) {
        one_packet(expansion, walls, scanner, tan_limit, triangle, x + i, y + i,
                   std::min(n, count - i), vf_rad + i, stack, counts);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vfplan
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vfplan {

HWY_EXPORT(all_packets);

void packet_angles(const Expansion& expansion, const std::vector<Wall>& walls,
                   const Scanner& scanner, std::int32_t triangle, const double* x, const double* y,
                   std::size_t count, double* vf_rad, PacketStack& stack, FieldCounts& counts) {
    HWY_DYNAMIC_DISPATCH(all_packets)
    (expansion, walls, scanner, triangle, x, y, count, vf_rad, stack, counts);
}

void limit_packet_isa(const std::string& isa) {
    std::int64_t newer = 0;
    if (isa != "avx512") newer |= HWY_AVX3 | HWY_AVX3_DL;
    if (isa != "avx512" && isa != "avx2") newer |= HWY_AVX2;
    if (isa == "sse2") newer |= HWY_SSE4 | HWY_SSSE3;
    hwy::DisableTargets(newer);
}

}  // namespace vfplan
#endif
