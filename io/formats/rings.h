// Polygons from the rings that make them up.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "io/features/feature.h"

namespace vfplan {

// Rings that do not cross, in any order and direction, as polygons: a ring within an odd number of
// others is a hole.
std::vector<Polygon> polygons_of(const std::vector<Ring>& rings);

// The closed ways along edges, each a pair of corners, in either direction; ways of two corners are
// left out. Empty when an edge leads to where none goes on.
using CornerPair = std::pair<std::size_t, std::size_t>;
std::optional<std::vector<Ring>> rings_along(const std::vector<CornerPair>& edges,
                                             const std::vector<Vec2d>& places);

// Faces of a mesh, each a ring of corners or several, that meet along whole edges, such as the
// triangles of a floor: those that hang together become one polygon (or several, where its rings
// lie apart). An edge of two of them goes, what is left makes rings.
using Corners = std::vector<std::size_t>;
std::vector<Polygon> united(const std::vector<std::vector<Corners>>& faces,
                            const std::vector<Vec2d>& places);

}  // namespace vfplan
