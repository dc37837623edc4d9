// Sweet Home 3D: a home as walls with thickness, rooms, doors and windows, in centimetres; y grows
// downwards.
#pragma once

#include "io/features/drawing.h"
#include "io/features/read_options.h"
#include "io/formats/xml_document.h"

namespace vfplan {

// Walls become polygons, mitred where they are joined; doors and windows the stretches of walls
// that they take up, so that they open what they stand in. Furniture is left out, unless site.roles
// says what it is. Of several levels options.layer names one. Throws InputError, with the line, for
// what is missing or no number, and for several levels of which none was named.
Drawing read_sweet_home(const XmlDocument& document, const ReadOptions& options);

}  // namespace vfplan
