// CityJSON 1.0, 1.1 and 2.0: the footprints of buildings.
#pragma once

#include "io/features/drawing.h"
#include "io/features/read_options.h"
#include "io/formats/json_document.h"

namespace vfplan {

// A building stands where its ground surfaces lie; where none are named, under the faces of its
// most detailed geometry that look down, and where none do (footprints, roofs alone), under all of
// them. Building parts count with their building. Throws InputError as JsonAt does.
Drawing read_cityjson(const JsonAt& root, const ReadOptions& options);

}  // namespace vfplan
