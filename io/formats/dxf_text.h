// DXF drawings in text form, before GDAL reads them: what it passes over in silence, and splines
// that are given by the points they lead through, of which it knows only those with control points.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace vfplan {

// Throws InputError, with the line, for a group code that is no number, and for a coordinate that
// is none. Drawings in binary form pass.
void check_dxf(const std::string& dxf, const std::filesystem::path& file);

// A drawing with each such spline as a polyline along the cubic B-spline through its points (by
// chord lengths), sixteen steps from point to point. Nothing when it has none.
std::optional<std::string> with_splines_drawn(const std::string& dxf);

}  // namespace vfplan
