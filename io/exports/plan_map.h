// map.png of a plan.
#pragma once

#include <filesystem>

#include "io/exports/outputs.h"

namespace vfplan {

// Fields of more than 2^24 cells are drawn by means over squares of cells. Throws IoError.
void write_map(const std::filesystem::path& path, const Results& results);

}  // namespace vfplan
