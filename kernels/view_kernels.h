// Which view kernel serves: the exact one or the rays.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "kernels/names.h"
#include "kernels/view.h"

namespace vfplan {

enum class KernelKind : std::uint8_t { exact, embree };

template <>
struct Names<KernelKind> {
    static constexpr std::array<std::string_view, 2> all = {"exact", "embree"};
};

// `rays` only matters to embree. Throws as the kernels do.
std::unique_ptr<ViewKernel> make_kernel(KernelKind kind, const std::vector<Wall>& walls,
                                        const Box& around, double reach_m, int rays);

}  // namespace vfplan
