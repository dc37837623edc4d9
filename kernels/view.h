// What a station sees: the heart that field, coverage and overlap all derive from.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernels/grid.h"
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

// What a field counts, for benchmarks and their gate.
struct FieldCounts {
    std::int64_t cells = 0;
    std::int64_t packets = 0;  // exact: groups of eyes; embree: groups of rays
    std::int64_t steps = 0;    // exact: edges crossed, per packet; embree: rays
    std::int64_t walls = 0;    // exact: walls met, per packet; embree: rays beyond the first ones

    FieldCounts& operator+=(const FieldCounts& o) {
        cells += o.cells;
        packets += o.packets;
        steps += o.steps;
        walls += o.walls;
        return *this;
    }
};

// A kernel answers one question: which walls does each direction meet first? For one eye as
// spans, and for all cells of a window as angles alone, where neighbours share the work.
//  (1) spans come in counter-clockwise order and overlap in no direction
//  (2) a span's side is the side that the eye is on
//  (3) directions in which no wall stands within the kernel's reach have no span
//  (4) equal input gives equal bits, on any machine and any number of threads
// Thread-safe: one kernel serves all threads; each thread brings its own scratch through View.
class ViewKernel {
public:
    virtual ~ViewKernel() = default;

    // First hits from `eye`, at least as far as reach_m, walls nearer than range_min included.
    // `out` is overwritten. REQUIRES: eye not on a wall.
    virtual void first_hits(const Vec2d& eye, View& out) const = 0;

    // VF of the window's standable cells (eq. 5) into `vf_rad`, whose other values stay. The
    // window's corners are multiples of window_step, or on the grid's border. REQUIRES: the
    // scanner's range_max_m is at most the kernel's reach.
    //  (5) a cell's value does not depend on the window it was asked for in
    virtual FieldCounts field(const Scanner& scanner, const Grid& grid, const Window& window,
                              const Raster<std::uint8_t>& standable,
                              Raster<float>& vf_rad) const = 0;
};

inline constexpr std::int32_t window_step = 4;

// Cuts first hits down to what the scanner observes: range_min_m <= d <= range_max_m and the
// incidence limit, walls with `scanned` false left out; fills the angles, and starts the list at
// the first span whose start lies counter-clockwise of the +x axis, so that sums over a view do
// not depend on where a kernel began. Equations 4 and 5.
//  (1) the sum of angle_rad is VF(eye)
//  (2) a span broken by the range_min circle gives two
void observe(const std::vector<Wall>& walls, const Scanner& scanner, const Vec2d& eye,
             const View& first_hits, View& out);

// The same for one stretch of a scanned wall, given by the directions of its ends (`from` is the
// clockwise one): the angle observed. `tan_limit` is tan_incidence(scanner).
double observed_angle_rad(const Wall& wall, const Scanner& scanner, double tan_limit,
                          const Vec2d& eye, const Vec2d& from, const Vec2d& to);

// Tangent of the incidence limit; -1 for none.
double tan_incidence(const Scanner& scanner);

// VF(o), eq. 5: total observed angle, 0..2 pi.
double view_angle_rad(const View& observed);

}  // namespace vfplan
