// HouseExpo: an apartment as one ring of free space, in metres (Li et al. 2019).
#pragma once

#include "io/features/drawing.h"
#include "io/features/read_options.h"
#include "io/formats/json_document.h"

namespace vfplan {

// "verts" is the outline; "room_category" has boxes around rooms, labels that are left out. Throws
// InputError as JsonAt does.
Drawing read_house_expo(const JsonAt& root, const ReadOptions& options);

}  // namespace vfplan
