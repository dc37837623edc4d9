#include "bench/peers/embree_quads.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>

#include "kernels/angle.h"

namespace vfplan::peers {

struct EmbreeQuads::Impl {
    RTCDevice device = rtcNewDevice("");
    RTCScene scene = rtcNewScene(device);
    Vec2d origin{0, 0};
    float reach_m = 0;
    mutable std::vector<Vec2d> directions;  // of the last number of rays
};

EmbreeQuads::EmbreeQuads(const std::vector<Wall>& walls, const Box& around, double reach_m)
    : impl_(std::make_unique<Impl>()) {
    Impl& m = *impl_;
    m.origin = (around.min + around.max) / 2;
    m.reach_m = static_cast<float>(reach_m);
    rtcSetSceneFlags(m.scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(m.device, RTC_GEOMETRY_TYPE_QUAD);
    auto* corner = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 4 * walls.size()));
    auto* index = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4, 16, walls.size()));
    for (const Wall& w : walls) {
        const Vec2d a = w.a - m.origin;
        const Vec2d b = w.b - m.origin;
        for (const auto& [p, z] : {std::pair(a, -1), {b, -1}, {b, 1}, {a, 1}}) {
            *corner++ = static_cast<float>(p.x());
            *corner++ = static_cast<float>(p.y());
            *corner++ = static_cast<float>(z);
        }
    }
    for (unsigned i = 0; i < 4 * walls.size(); ++i) index[i] = i;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(m.scene);
}

EmbreeQuads::~EmbreeQuads() {
    rtcReleaseScene(impl_->scene);
    rtcReleaseDevice(impl_->device);
}

std::int64_t EmbreeQuads::cast(const std::vector<Vec2d>& eyes, int rays) const {
    const Impl& m = *impl_;
    if (m.directions.size() != static_cast<std::size_t>(rays)) {
        m.directions.clear();
        for (int r = 0; r < rays; ++r) {
            const double angle = 2 * pi * r / rays;
            m.directions.emplace_back(std::cos(angle), std::sin(angle));
        }
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    alignas(64) int valid[16];
    alignas(64) RTCRayHit16 packet{};
    for (std::size_t i = 0; i < 16; ++i) {
        const Vec2d local = eyes[std::min(i, eyes.size() - 1)] - m.origin;
        valid[i] = i < eyes.size() ? -1 : 0;
        packet.ray.org_x[i] = static_cast<float>(local.x());
        packet.ray.org_y[i] = static_cast<float>(local.y());
        packet.ray.mask[i] = ~0U;
    }
    std::int64_t hits = 0;
    for (int r = 0; r < rays; ++r) {
        const Vec2d& d = m.directions[static_cast<std::size_t>(r)];
        std::fill_n(packet.ray.dir_x, 16, static_cast<float>(d.x()));
        std::fill_n(packet.ray.dir_y, 16, static_cast<float>(d.y()));
        std::fill_n(packet.ray.tfar, 16, m.reach_m);
        std::fill_n(packet.hit.geomID, 16, RTC_INVALID_GEOMETRY_ID);
        rtcIntersect16(valid, m.scene, &context, &packet);
        for (std::size_t i = 0; i < eyes.size(); ++i) {
            hits += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
        }
    }
    return hits;
}

}  // namespace vfplan::peers
