// Snap rounding: segments that cross, touch and overlap anyhow become edges that share nothing but
// their ends, and every end lies on a lattice (docs/method.md 1).
//
// A pixel of the lattice is hot when the end of a segment or a proper crossing of two lies in it.
// Each segment is led through the centres of the hot pixels that it passes, in order (Hobby,
// "Practical segment intersection with finite precision output", 1999). So no point of it moves by
// more than half a pixel in x or y, closed rings stay closed, and no two edges cross or touch
// between their ends. All decisions are exact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "kernels/vec.h"

namespace vfplan {

// A place in whole lattice steps (ends of edges) or in fine steps (ends of segments).
struct LatticePoint {
    std::int64_t x = 0;
    std::int64_t y = 0;
    friend auto operator<=>(const LatticePoint&, const LatticePoint&) = default;
};

inline Vec2d as_vec(const LatticePoint& p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y)};
}

// Products of coordinates.
__extension__ using Wide = __int128;

// z of (b - a) x (c - a): positive when c lies left of a -> b. Exact.
inline Wide turn(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
    return Wide(b.x - a.x) * (c.y - a.y) - Wide(b.y - a.y) * (c.x - a.x);
}

// Fine steps to a lattice step. A pixel reaches half a lattice step from its centre, its lower and
// left border included, the others not.
inline constexpr std::int64_t fine_steps = 1024;

// The pixel that a place in fine steps lies in, by its centre in lattice steps.
LatticePoint pixel_of(const LatticePoint& fine);

// A straight piece of linework, in fine steps. The label tells the caller where it is from.
struct LabelledSegment {
    LatticePoint a;
    LatticePoint b;
    std::int32_t label = 0;
};

struct Noded {
    struct Edge {
        LatticePoint a;  // a < b
        LatticePoint b;
        std::size_t first_label = 0;
    };
    // A proper crossing of two segments of one label.
    struct SelfCrossing {
        std::int32_t label = 0;
        LatticePoint at;
    };
    std::vector<Edge> edges;                   // ascending by (a, b), each once
    std::vector<std::int32_t> labels;          // those of edge 0, ascending, then of edge 1, ...
    std::vector<SelfCrossing> self_crossings;  // ascending by (label, at), each once

    // Labels of the segments that were led along an edge; one of a segment there and back stands
    // twice.
    std::span<const std::int32_t> labels_of(std::size_t edge) const;
};

// Segments that lie further than this from each other, in fine steps, are too far for exact
// arithmetic: 1,000 km at a lattice of 1 mm.
inline constexpr std::int64_t farthest_fine = std::int64_t{1} << 40;

// Equal input gives equal output, and so does any order of the segments. Segments within a pixel
// vanish, but make it hot: one of no length puts a node where others pass. Throws InputError when
// the segments spread over more than farthest_fine. Thread-safe. Time O((n + crossings) log n)
// where segments are short against the site.
Noded node(std::span<const LabelledSegment> segments);

}  // namespace vfplan
