// Rays in packets of 16: what the ray kernel asks of Embree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/vec.h"

namespace vfplan {

inline constexpr std::size_t packet_rays = 16;

// One value per ray of a packet.
template <class T>
using PerRay = std::array<T, packet_rays>;

// The first wall along each ray; -1 where none stands within the kernel's reach. Among equally
// near walls the one with the lowest number.
class RayTracer {
public:
    virtual ~RayTracer() = default;

    // Eyes of the packets that along() traces. 0 < `count` <= 16; the rest of the array is ignored.
    virtual void set_eyes(const PerRay<Vec2d>& eyes, std::size_t count) = 0;
    // One direction for each eye: 16 unit vectors, the rest ignored as with the eyes.
    virtual void along(const Vec2d* directions, PerRay<std::int32_t>& wall) = 0;
    // Rays of their own, 0 < `count` <= 16.
    virtual void trace(const Vec2d* eyes, const Vec2d* directions, std::size_t count,
                       std::int32_t* wall) = 0;
};

}  // namespace vfplan
