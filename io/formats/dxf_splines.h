// DXF splines that are given by the points they lead through: GDAL knows only those with control
// points.
#pragma once

#include <optional>
#include <string>

namespace vfplan {

// A drawing in text form with each such spline as a polyline along the cubic B-spline through its
// points (by chord lengths), sixteen steps from point to point. Nothing when it has none. Throws
// nothing: what is wrong in a drawing is for GDAL to say.
std::optional<std::string> with_splines_drawn(const std::string& dxf);

}  // namespace vfplan
