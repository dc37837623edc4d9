// Structured3D: a house as planes, lines and junctions (Zheng et al. 2020), in millimetres.
#pragma once

#include "io/features/drawing.h"
#include "io/features/read_options.h"
#include "io/formats/json_document.h"

namespace vfplan {

// Floors of rooms become rooms, their borders walls. A door is the rectangle around its planes,
// seen from above, so it opens the walls of both its rooms; a window the stretch of wall that it
// takes up. Throws InputError as JsonAt does, and for a floor whose lines make no ring.
Drawing read_structured3d(const JsonAt& root, const ReadOptions& options);

}  // namespace vfplan
