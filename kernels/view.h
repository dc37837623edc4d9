// What a station sees: the heart that field, coverage and overlap all derive from.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/scanner.h"
#include "kernels/wall.h"

namespace vfplan {

// An unbroken stretch of one wall's side. Seen from the eye it runs counter-clockwise from
// `s_begin_m` to `s_end_m`, metres along the wall from wall.a (increasing on a left side,
// decreasing on a right one).
struct Span {
    std::int32_t wall = -1;
    Side side = left;
    double s_begin_m = 0;
    double s_end_m = 0;
    double angle_rad = 0;  // filled by observe(); first hits leave it at 0
};

// Spans in counter-clockwise order around the eye.
using View = std::vector<Span>;

// A kernel answers one question: which walls does each direction meet first?
//  (1) spans come in counter-clockwise order and overlap in no direction
//  (2) a span's side is the side that the eye is on
//  (3) directions in which no wall stands within reach() have no span
//  (4) equal input gives equal bits, on any machine and any number of threads
// Thread-safe: one kernel serves all threads; each thread brings its own scratch through View.
class ViewKernel {
public:
    virtual ~ViewKernel() = default;

    // First hits from `eye`, at least as far as reach_m, walls nearer than range_min included.
    // `out` is overwritten. REQUIRES: eye not on a wall.
    virtual void first_hits(const Vec2d& eye, View& out) const = 0;
};

// Cuts first hits down to what the scanner observes: range_min_m <= d <= range_max_m and the
// incidence limit, walls with `scanned` false left out; fills the angles, and starts the list at
// the first span whose start lies counter-clockwise of the +x axis, so that sums over a view do
// not depend on where a kernel began. Equations 4 and 5.
//  (1) the sum of angle_rad is VF(eye)
//  (2) a span broken by the range_min circle gives two
void observe(const std::vector<Wall>& walls, const Scanner& scanner, const Vec2d& eye,
             const View& first_hits, View& out);

// VF(o), eq. 5: total observed angle, 0..2 pi.
double view_angle_rad(const View& observed);

}  // namespace vfplan
