#include "kernels/embree_scene.h"

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

#include "kernels/angle.h"
#include "kernels/error.h"
#include "kernels/transitions.h"

namespace vfplan {
namespace {

constexpr int packet_size = 16;

// Embree wants denormals off while it traces; CGAL must never see that, so it ends with the scope.
class DenormalsOff {
public:
    DenormalsOff() : saved_(_mm_getcsr()) {
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
    }
    ~DenormalsOff() { _mm_setcsr(saved_); }
    DenormalsOff(const DenormalsOff&) = delete;
    DenormalsOff& operator=(const DenormalsOff&) = delete;

private:
    unsigned saved_;
};

std::string& device_settings() {
    static std::string settings;
    return settings;
}

// One device for the process. No "threads=": that would throttle TBB everywhere.
RTCDevice device() {
    static const RTCDevice d = rtcNewDevice(device_settings().c_str());
    if (d == nullptr) throw Error(Exit::io, "Embree found no usable processor features");
    return d;
}

// A ray packet in double precision, beside Embree's own float one. `base` must come first: Embree
// hands back a pointer to it.
struct Packet {
    RTCIntersectContext base;
    Vec2d eye;
    std::array<Vec2d, packet_size> direction;
    std::array<double, packet_size> nearest;
    std::array<std::int32_t, packet_size> wall;
};

struct Segments {
    const std::vector<Wall>* walls;
    Vec2d local_origin;
    float padding_m;
};

void wall_bounds(const RTCBoundsFunctionArguments* args) {
    const auto& s = *static_cast<const Segments*>(args->geometryUserPtr);
    const Wall& w = (*s.walls)[args->primID];
    const Vec2d lo = w.a.cwiseMin(w.b) - s.local_origin;
    const Vec2d hi = w.a.cwiseMax(w.b) - s.local_origin;
    RTCBounds& b = *args->bounds_o;
    b.lower_x = static_cast<float>(lo.x()) - s.padding_m;
    b.lower_y = static_cast<float>(lo.y()) - s.padding_m;
    b.lower_z = -1;
    b.upper_x = static_cast<float>(hi.x()) + s.padding_m;
    b.upper_y = static_cast<float>(hi.y()) + s.padding_m;
    b.upper_z = 1;
}

void wall_intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& s = *static_cast<const Segments*>(args->geometryUserPtr);
    const Wall& w = (*s.walls)[args->primID];
    Packet& packet = *reinterpret_cast<Packet*>(args->context);
    const auto id = static_cast<std::int32_t>(args->primID);
    RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, args->N);
    RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, args->N);
    const Vec2d to_a = w.a - packet.eye;
    const Vec2d e = w.b - w.a;
    const double reach = cross(to_a, e);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        const std::size_t k = RTCRayN_id(ray, args->N, i);
        const Vec2d& d = packet.direction[k];
        const double den = cross(d, e);
        if (den == 0) continue;
        const double u = cross(to_a, d) / den;
        if (!(u >= 0 && u <= 1)) continue;
        const double t = reach / den;
        if (!(t > 0) || t > packet.nearest[k]) continue;
        if (t == packet.nearest[k] && packet.wall[k] >= 0 && packet.wall[k] < id) continue;
        packet.nearest[k] = t;
        packet.wall[k] = id;
        // A little beyond, so that boxes with an equally near wall are still opened.
        RTCRayN_tfar(ray, args->N, i) = static_cast<float>(t) * 1.000001F + s.padding_m;
        RTCHitN_primID(hit, args->N, i) = args->primID;
        RTCHitN_geomID(hit, args->N, i) = args->geomID;
    }
}

}  // namespace

struct EmbreeScene::Impl {
    std::vector<Wall> walls;
    Segments segments{};
    double reach_m = 0;
    std::vector<Vec2d> directions;
    RTCScene scene = nullptr;

    // The first walls along up to packet_size directions.
    void trace(const Vec2d& eye, const Vec2d* direction, std::size_t count,
               std::int32_t* wall) const {
        assert(count <= packet_size);
        Packet packet;
        rtcInitIntersectContext(&packet.base);
        packet.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        packet.eye = eye;
        alignas(64) std::array<int, packet_size> valid{};
        alignas(64) RTCRayHit16 rays{};
        const Vec2d local = eye - segments.local_origin;
        for (std::size_t i = 0; i < packet_size; ++i) {
            const Vec2d& d = direction[std::min(i, count - 1)];
            valid[i] = i < count ? -1 : 0;
            packet.direction[i] = d;
            packet.nearest[i] = reach_m;
            packet.wall[i] = -1;
            rays.ray.org_x[i] = static_cast<float>(local.x());
            rays.ray.org_y[i] = static_cast<float>(local.y());
            rays.ray.dir_x[i] = static_cast<float>(d.x());
            rays.ray.dir_y[i] = static_cast<float>(d.y());
            rays.ray.tfar[i] = static_cast<float>(reach_m) * 1.000001F + segments.padding_m;
            rays.ray.mask[i] = ~0U;
            rays.ray.id[i] = static_cast<unsigned>(i);
            rays.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
        rtcIntersect16(valid.data(), scene, &packet.base, &rays);
        std::copy_n(packet.wall.begin(), count, wall);
    }

    void trace_all(const Vec2d& eye, const std::vector<Vec2d>& direction,
                   std::vector<std::int32_t>& wall) const {
        const DenormalsOff scope;
        wall.resize(direction.size());
        for (std::size_t i = 0; i < direction.size(); i += packet_size) {
            trace(eye, &direction[i], std::min<std::size_t>(packet_size, direction.size() - i),
                  &wall[i]);
        }
    }
};

EmbreeScene::EmbreeScene(const std::vector<Wall>& walls, const Box& around, double reach_m,
                         int rays)
    : impl_(std::make_unique<Impl>()) {
    Impl& m = *impl_;
    m.walls = walls;
    m.reach_m = reach_m;
    m.directions = circle_directions(rays);
    const Vec2d middle = (around.min + around.max) / 2;
    // Float keeps 24 bits: pad the boxes by what it loses at this size, and by a millimetre.
    const double size = around.size().norm() + reach_m;
    m.segments = {&m.walls, middle, static_cast<float>(1e-3 + 4e-7 * size)};
    m.scene = rtcNewScene(device());
    rtcSetSceneFlags(m.scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(m.walls.size()));
    rtcSetGeometryUserData(geometry, &m.segments);
    rtcSetGeometryBoundsFunction(geometry, wall_bounds, nullptr);
    rtcSetGeometryIntersectFunction(geometry, wall_intersect);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(m.scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(m.scene);
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(impl_->scene); }

void EmbreeScene::first_hits(const Vec2d& eye, View& out) const {
    const Impl& m = *impl_;
    follow_transitions(
        m.walls, eye, m.directions,
        [&](const std::vector<Vec2d>& d, std::vector<std::int32_t>& wall) {
            m.trace_all(eye, d, wall);
        },
        out);
}

FieldCounts EmbreeScene::field(const Scanner& scanner, const Grid& grid, const Window& window,
                               const Raster<std::uint8_t>& standable, Raster<float>& vf_rad) const {
    View hits;
    View seen;
    FieldCounts counts;
    for (std::int32_t iy = window.y_begin; iy < window.y_end; ++iy) {
        for (std::int32_t ix = window.x_begin; ix < window.x_end; ++ix) {
            const auto i = static_cast<std::size_t>(grid.id(ix, iy));
            if (standable[i] == 0) continue;
            const Vec2d eye = grid.centre(grid.id(ix, iy));
            first_hits(eye, hits);
            observe(impl_->walls, scanner, eye, hits, seen);
            vf_rad[i] = static_cast<float>(view_angle_rad(seen));
        }
    }
    return counts;
}

void limit_embree_isa(const std::string& isa) { device_settings() = "isa=" + isa; }

int default_rays(double range_max_m, double partition_m) {
    const double wanted = 2 * pi * range_max_m / (2.5 * partition_m);
    int rays = 128;
    while (rays < 512 && rays < wanted) rays *= 2;
    return rays;
}

}  // namespace vfplan
