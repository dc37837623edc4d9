#include "kernels/angle.h"

#include <cassert>

namespace vfplan {

// Range reduction to |x| <= 0.66 and a rational approximation there; the coefficients are the
// published ones of Moshier's Cephes library.
double atan_exact_bits(double x) {
    const bool negative = x < 0;
    double t = negative ? -x : x;
    double base = 0;
    double rest = 0;  // what pi/2 and pi/4 lose in rounding
    if (t > 2.41421356237309504880) {
        base = pi / 2;
        rest = 6.123233995736765886130e-17;
        t = -1 / t;
    } else if (t > 0.66) {
        base = pi / 4;
        rest = 3.061616997868382943065e-17;
        t = (t - 1) / (t + 1);
    }
    const double z = t * t;
    const double p = (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z -
                       7.500855792314704667340e1) *
                          z -
                      1.228866684490136173410e2) *
                         z -
                     6.485021904942025371773e1;
    const double q = ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z +
                       4.328810604912902668951e2) *
                          z +
                      4.853903996359136964868e2) *
                         z +
                     1.945506571482613964425e2;
    const double result = base + ((t * (z * p / q) + t) + rest);
    return negative ? -result : result;
}

double angle_upper_rad(double y, double x) {
    if (x > 0) return atan_exact_bits(y / x);
    if (x < 0) return pi + atan_exact_bits(y / x);
    return y > 0 ? pi / 2 : 0;
}

double angle_between_rad(const Vec2d& u, const Vec2d& v) {
    const double c = cross(u, v);
    const double d = u.dot(v);
    if (c >= 0) return angle_upper_rad(c, d);
    return 2 * pi - angle_upper_rad(-c, d);
}

std::vector<Vec2d> circle_directions(int count) {
    assert(count >= 4 && (count & (count - 1)) == 0);
    std::vector<Vec2d> d = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    while (static_cast<int>(d.size()) < count) {
        std::vector<Vec2d> finer;
        finer.reserve(2 * d.size());
        for (std::size_t i = 0; i < d.size(); ++i) {
            const Vec2d sum = d[i] + d[(i + 1) % d.size()];
            finer.push_back(d[i]);
            finer.emplace_back(sum / std::sqrt(sum.x() * sum.x() + sum.y() * sum.y()));
        }
        d = std::move(finer);
    }
    return d;
}

}  // namespace vfplan
