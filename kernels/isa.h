// Which instruction sets the kernels may use.
#pragma once

#include <string>

namespace vfplan {

// Holds all kernels to an older instruction set (sse2, sse4.2, avx, avx2, avx512), to show that
// results do not depend on it. Call before the first scene. Throws UsageError for another name.
void limit_isa(const std::string& isa);

}  // namespace vfplan
