#include "io/site/openings.h"

#include <limits>
#include <map>
#include <queue>

#include "io/site/passages.h"

namespace vfplan {
namespace {

class Curve : Passages {
public:
    using Passages::Passages;

    std::vector<OpeningStep> steps(double up_to_m) const {
        const std::vector<double> widest = widest_ways_m();
        std::map<double, double> area_at;  // by the width from which on it is inside
        double all_m2 = 0;
        for (std::int32_t t = 0; idx(t) < n_; ++t) {
            constexpr Kinds said = bit(outline_area) | bit(room_area);
            if ((s_.kinds[idx(t)] & said) != 0) return {};
            if (taken(t) || widest[idx(t)] > up_to_m) continue;
            area_at[widest[idx(t)]] += triangle_m2(t);
            all_m2 += triangle_m2(t);
        }
        std::vector<OpeningStep> out;
        double inside_m2 = 0;
        double said_m2 = 0;
        double first_m = 0;
        for (const auto& [width_m, m2] : area_at) {
            // A room comes in by the triangles of its opening: widths that are nearly the same.
            constexpr double same_m = 0.05;
            if (width_m > first_m + same_m) first_m = width_m;
            inside_m2 += m2;
            if (inside_m2 - said_m2 < std::max(1.0, 0.01 * all_m2)) continue;
            if (!out.empty() && out.back().opening_m >= first_m) {
                out.back().inside_m2 = inside_m2;
            } else {
                out.push_back({width_m, inside_m2});
            }
            said_m2 = inside_m2;
        }
        return out;
    }

private:
    // By triangle the narrowest gap on the widest way to it from outside; 0 where there is none.
    std::vector<double> widest_ways_m() const {
        std::vector<double> widest(n_, 0);
        std::priority_queue<std::pair<double, std::int32_t>> next;
        for (const std::int32_t t : at_the_rim()) {
            widest[idx(t)] = std::numeric_limits<double>::infinity();
            next.emplace(widest[idx(t)], t);
        }
        while (!next.empty()) {
            const auto [width, t] = next.top();
            next.pop();
            if (width < widest[idx(t)]) continue;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::int32_t to = over(t, i);
                if (to < 0 || is_shut(t, i) || taken(to) || named(to)) continue;
                const double by = std::min(width, width_m(t, i));
                if (by <= widest[idx(to)]) continue;
                widest[idx(to)] = by;
                next.emplace(by, to);
            }
        }
        return widest;
    }
};

}  // namespace

std::vector<OpeningStep> opening_steps(const Subdivision& s, const std::vector<bool>& wall,
                                       const std::vector<bool>& shut, double snap_m,
                                       double up_to_m) {
    return Curve(s, wall, shut, snap_m).steps(up_to_m);
}

}  // namespace vfplan
