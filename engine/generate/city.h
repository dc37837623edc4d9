// Blocks, streets and towers. See GenerateOptions.
#pragma once

#include <cstdint>

#include "engine/generate/generate.h"

namespace vfplan::generate {

GenerateReport city(std::uint64_t seed, double size_km);

}  // namespace vfplan::generate
