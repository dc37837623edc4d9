// How much two stations (or candidates for them) cover in common: equations 8 to 12.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "kernels/names.h"

namespace vfplan {

// Sums over the pieces that a station covers, each counted whole.
struct SeenTotal {
    double length_m = 0;
    double angle_rad = 0;
};

// The same over the pieces that two stations cover: length, and angle from each of them.
struct SeenJointly {
    double length_m = 0;
    double angle_a_rad = 0;
    double angle_b_rad = 0;
};

enum class OverlapRatio : std::uint8_t {
    min_len,
    mean_len,
    union_len,
    union_ang,
    mean_ang,
    count  // how many there are
};

struct OverlapFormula {
    OverlapRatio ratio;
    std::string_view name;
    bool by_angle;  // needs angles
    double (*of)(const SeenTotal& a, const SeenTotal& b, const SeenJointly& joint);
};

namespace overlap_formulas {

// 0 where nothing is seen.
constexpr double share(double part, double whole) { return whole > 0 ? part / whole : 0.0; }

}  // namespace overlap_formulas

// All that is known of the ratios, in the order of the enumeration.
inline constexpr std::array overlap_ratios = {
    OverlapFormula{OverlapRatio::min_len, "min_len", false,
                   [](const SeenTotal& a, const SeenTotal& b, const SeenJointly& joint) {
                       return overlap_formulas::share(joint.length_m,
                                                      std::min(a.length_m, b.length_m));
                   }},
    OverlapFormula{OverlapRatio::mean_len, "mean_len", false,
                   [](const SeenTotal& a, const SeenTotal& b, const SeenJointly& joint) {
                       return overlap_formulas::share(2 * joint.length_m, a.length_m + b.length_m);
                   }},
    OverlapFormula{OverlapRatio::union_len, "union_len", false,
                   [](const SeenTotal& a, const SeenTotal& b, const SeenJointly& joint) {
                       return overlap_formulas::share(joint.length_m,
                                                      a.length_m + b.length_m - joint.length_m);
                   }},
    OverlapFormula{OverlapRatio::union_ang, "union_ang", true,
                   [](const SeenTotal& a, const SeenTotal& b, const SeenJointly& joint) {
                       return overlap_formulas::share(joint.angle_a_rad + joint.angle_b_rad,
                                                      a.angle_rad + b.angle_rad);
                   }},
    OverlapFormula{OverlapRatio::mean_ang, "mean_ang", true,
                   [](const SeenTotal& a, const SeenTotal& b, const SeenJointly& joint) {
                       return overlap_formulas::share(joint.angle_a_rad, 2 * a.angle_rad) +
                              overlap_formulas::share(joint.angle_b_rad, 2 * b.angle_rad);
                   }},
};

inline constexpr auto overlap_ratio_count = static_cast<std::size_t>(OverlapRatio::count);
static_assert(overlap_ratios.size() == overlap_ratio_count, "each ratio has its formula");
static_assert(
    [] {
        for (std::size_t r = 0; r < overlap_ratios.size(); ++r) {
            if (overlap_ratios[r].ratio != static_cast<OverlapRatio>(r)) return false;
        }
        return true;
    }(),
    "formulas stand in the order of the enumeration");

template <>
struct Names<OverlapRatio> {
    static constexpr auto all = [] {
        std::array<std::string_view, overlap_ratio_count> names;
        for (const OverlapFormula& f : overlap_ratios) {
            names[static_cast<std::size_t>(f.ratio)] = f.name;
        }
        return names;
    }();
};

constexpr const OverlapFormula& formula(OverlapRatio ratio) {
    return overlap_ratios[static_cast<std::size_t>(ratio)];
}

//  (1) 0 <= O <= 1;  (2) O(a, b) == O(b, a);  (3) O(a, a) == 1 where a sees anything
//  (4) 0 where the denominator is 0
inline double overlap(OverlapRatio ratio, const SeenTotal& a, const SeenTotal& b,
                      const SeenJointly& joint) {
    return formula(ratio).of(a, b, joint);
}

// When two stations can be registered with each other.
struct OverlapRule {
    OverlapRatio ratio = OverlapRatio::mean_len;
    double threshold = 0.3;

    // A tie is enough, though sums of lengths round it off by a bit or two.
    bool enough(double overlap) const {
        constexpr double rounding = 1e-12;
        return overlap > 0 && overlap >= threshold - rounding;
    }
};

// The largest threshold of another ratio at which every pair that a rule finds enough is enough by
// that ratio as well; 0 where there is none. By length, with m for mean_len: union_len is
// m / (2 - m), and min_len is at least m.
inline double implied_threshold(const OverlapRule& rule, OverlapRatio ratio) {
    if (rule.ratio == ratio) return rule.threshold;
    const double mean = rule.ratio == OverlapRatio::mean_len ? rule.threshold
                        : rule.ratio == OverlapRatio::union_len
                            ? 2 * rule.threshold / (1 + rule.threshold)
                            : 0;
    switch (ratio) {
        case OverlapRatio::min_len:
        case OverlapRatio::mean_len:
            return mean;
        case OverlapRatio::union_len:
            return mean / (2 - mean);
        default:
            return 0;
    }
}

}  // namespace vfplan
