// AGPLIB: a polygon with holes of the art-gallery problem, coordinates as exact fractions.
#pragma once

#include <filesystem>
#include <string>

#include "io/features/drawing.h"
#include "io/features/read_options.h"

namespace vfplan {

// Whether a text begins as such a file: a count and two fractions or numbers, and nothing but
// those.
bool looks_like_art_gallery(const std::string& head);

// The gallery becomes an outline. Throws InputError, with line and column, for what is no number, a
// denominator of 0, and fewer or more points than the file says.
Drawing read_art_gallery(const std::string& text, const std::filesystem::path& file,
                         const ReadOptions& options);

}  // namespace vfplan
