// Sites in any vector format that GDAL knows.
#pragma once

#include <filesystem>

#include "io/features/drawing.h"
#include "io/features/read_options.h"
#include "io/formats/gdal.h"

namespace vfplan {

// Throws InputError for what is no vector data or damaged, and for several layers of which none was
// named; UsageError for an attribute filter that the layer does not understand.
Drawing read_vector(const PackedFile& packed, const std::filesystem::path& file,
                    const ReadOptions& options);

}  // namespace vfplan
