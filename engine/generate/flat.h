// An apartment. See GenerateOptions.
#pragma once

#include <cstdint>

#include "engine/generate/generate.h"

namespace vfplan::generate {

GenerateReport flat(std::uint64_t seed, int rooms);

}  // namespace vfplan::generate
