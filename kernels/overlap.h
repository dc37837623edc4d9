// How much two stations see in common: the five ratios of equations 8 to 12.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "kernels/coverage.h"

namespace vfplan {

enum class OverlapRatio : std::uint8_t { min_len, mean_len, union_len, union_ang, mean_ang };

inline constexpr std::array<std::string_view, 5> overlap_ratio_names = {
    "min_len", "mean_len", "union_len", "union_ang", "mean_ang"};

// What one station sees in all.
struct SeenTotal {
    double length_m = 0;
    double angle_rad = 0;
};

// What two stations see in common: the length, and its angle from each of them.
struct SeenJointly {
    double length_m = 0;
    double angle_a_rad = 0;
    double angle_b_rad = 0;
};

// Sums over whole pieces with C = 1, in order of piece.
SeenTotal seen_total(const Pieces& pieces, const Seen* begin, const Seen* end);
SeenJointly seen_jointly(const Pieces& pieces, const Seen* a, const Seen* a_end, const Seen* b,
                         const Seen* b_end);

//  (1) 0 <= O <= 1;  (2) O(a, b) == O(b, a);  (3) O(a, a) == 1 where a sees anything
//  (4) 0 where the denominator is 0
double overlap(OverlapRatio ratio, const SeenTotal& a, const SeenTotal& b,
               const SeenJointly& joint);

// Straight from two rows.
double overlap(OverlapRatio ratio, const Pieces& pieces, const CoverageRow& a,
               const CoverageRow& b);

// A row that brings the lengths of its pieces along, for places where the table of all pieces is
// not at hand.
struct SeenLength {
    std::int32_t piece = 0;
    float angle_rad = 0;
    double length_m = 0;
};
struct OverlapRow {
    std::vector<SeenLength> seen;  // ascending
    SeenTotal total;
};
OverlapRow overlap_row(std::vector<SeenLength> seen);
// The same bits as from two rows and their pieces.
double overlap(OverlapRatio ratio, const OverlapRow& a, const OverlapRow& b);

// A pair of candidates that overlap at all. from < to.
struct OverlapPair {
    std::int32_t from = 0;
    std::int32_t to = 0;
    double overlap = 0;
};

}  // namespace vfplan
