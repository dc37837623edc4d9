// Compiled once per instruction set, like packet_angles.cpp.
#include "kernels/wall_test.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/wall_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vfplan {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// With den the z of direction x edge, the wall is met where 0 <= u <= den (u counts along the
// wall) at t / den metres.
void test_wall(const Wall& wall, std::int32_t id, float padding_m, std::size_t first,
               std::size_t count, RayPacket& packet) {
    const hn::ScalableTag<double> d;
    const hn::Rebind<float, decltype(d)> f;
    const auto zero = hn::Zero(d);
    const auto edge_x = hn::Set(d, wall.b.x() - wall.a.x());
    const auto edge_y = hn::Set(d, wall.b.y() - wall.a.y());
    const auto number = hn::Set(d, static_cast<double>(id));
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t i = first - first % lanes; i < first + count; i += lanes) {
        const auto dx = hn::Load(d, &packet.direction_x[i]);
        const auto dy = hn::Load(d, &packet.direction_y[i]);
        const auto ax = hn::Sub(hn::Set(d, wall.a.x()), hn::Load(d, &packet.eye_x[i]));
        const auto ay = hn::Sub(hn::Set(d, wall.a.y()), hn::Load(d, &packet.eye_y[i]));
        const auto den = hn::Sub(hn::Mul(dx, edge_y), hn::Mul(dy, edge_x));
        const auto u = hn::Sub(hn::Mul(ax, dy), hn::Mul(ay, dx));
        const auto t = hn::Sub(hn::Mul(ax, edge_y), hn::Mul(ay, edge_x));
        const auto flip = hn::Lt(den, zero);
        const auto den_up = hn::IfThenElse(flip, hn::Neg(den), den);
        const auto u_up = hn::IfThenElse(flip, hn::Neg(u), u);
        const auto t_up = hn::IfThenElse(flip, hn::Neg(t), t);
        const auto meets = hn::And(hn::And(hn::Ge(u_up, zero), hn::Le(u_up, den_up)),
                                   hn::And(hn::Gt(den_up, zero), hn::Gt(t_up, zero)));
        if (hn::AllFalse(d, meets)) continue;
        const auto metres = hn::Div(t_up, den_up);
        const auto nearest = hn::Load(d, &packet.nearest_m[i]);
        const auto holder = hn::Load(d, &packet.wall[i]);
        const auto takes =
            hn::And(meets, hn::Or(hn::Lt(metres, nearest),
                                  hn::And(hn::Eq(metres, nearest), hn::Lt(number, holder))));
        if (hn::AllFalse(d, takes)) continue;
        const auto now = hn::IfThenElse(takes, metres, nearest);
        hn::Store(now, d, &packet.nearest_m[i]);
        hn::Store(hn::IfThenElse(takes, number, holder), d, &packet.wall[i]);
        hn::StoreU(
            hn::Add(hn::Mul(hn::DemoteTo(f, now), hn::Set(f, 1.000001F)), hn::Set(f, padding_m)), f,
            &packet.far_m[i]);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace vfplan
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vfplan {

HWY_EXPORT(test_wall);

WallTest wall_test() {
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    return HWY_DYNAMIC_DISPATCH(test_wall);
}

}  // namespace vfplan
#endif
