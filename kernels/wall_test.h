// A packet of rays against one wall, in double precision and SIMD.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/ray_tracer.h"
#include "kernels/wall.h"

namespace vfplan {

struct alignas(64) RayPacket {
    PerRay<double> eye_x, eye_y;
    PerRay<double> direction_x, direction_y;
    PerRay<double> nearest_m;
    PerRay<double> wall;  // its number; as double, so that all lanes are equally wide
    PerRay<float> far_m;  // a little beyond nearest_m, so that equally near walls are looked at too
};

// Takes the wall for rays that meet it nearer than all before, or as near and with a lower number:
// those of [first, first + count), and perhaps others of the packet, for which it is as true. far_m
// becomes float(nearest_m) * 1.000001 + padding_m.
using WallTest = void (*)(const Wall& wall, std::int32_t id, float padding_m, std::size_t first,
                          std::size_t count, RayPacket& packet);

// The fastest one that this processor and limit_isa() allow.
WallTest wall_test();

}  // namespace vfplan
