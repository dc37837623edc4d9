#include "kernels/isa.h"

#include <algorithm>
#include <array>

#include "kernels/embree_scene.h"
#include "kernels/error.h"
#include "kernels/packet_angles.h"

namespace vfplan {

void limit_isa(const std::string& isa) {
    constexpr std::array<const char*, 5> known = {"sse2", "sse4.2", "avx", "avx2", "avx512"};
    if (std::find(known.begin(), known.end(), isa) == known.end()) {
        throw UsageError("VFPLAN_ISA = " + isa + ": must be sse2, sse4.2, avx, avx2 or avx512");
    }
    limit_embree_isa(isa);
    limit_packet_isa(isa);
}

}  // namespace vfplan
