// Which areas the faces of noded linework belong to.
//
// Topology decides, no point is probed: from a face that lies in no area, every edge that is
// crossed flips inside and outside of the areas on whose border it lies (docs/method.md 1). An area
// is what an odd number of its borders surround, so rings that cross themselves count as their two
// loops, a hole is a hole whatever its direction, and areas may overlap.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kernels/noding.h"
#include "kernels/triangulation.h"

namespace vfplan {

// Of a label: the kind of its area, 0 to 15, or line for linework that surrounds nothing.
using AreaKind = std::int8_t;
inline constexpr AreaKind line_kind = -1;

// Bit k is set when at least one area of kind k surrounds the triangle.
using Kinds = std::uint16_t;

// For every triangle the kinds of areas around it. `triangles` is a triangulation of the edges of
// `noded` (Triangle::wall is the edge's number) that reaches beyond them, `kind_of` the kind of
// every label. Thread-safe. Time O(triangles + labels).
std::vector<Kinds> kinds_around(const Triangulation& triangles, const Noded& noded,
                                std::span<const AreaKind> kind_of);

}  // namespace vfplan
