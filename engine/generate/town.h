// The paper's town. See GenerateOptions.
#pragma once

#include <cstdint>

#include "engine/generate/generate.h"

namespace vfplan::generate {

GenerateReport town(std::uint64_t seed);

}  // namespace vfplan::generate
