#include "kernels/embree_scene.h"

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kernels/angle.h"
#include "kernels/block_field.h"
#include "kernels/error.h"
#include "kernels/index.h"
#include "kernels/transitions.h"
#include "kernels/wall_test.h"

namespace vfplan {
namespace {

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

// Embree hands back a pointer to `base`, so it must come first. Its own rays are floats; the
// packet holds the same ones as doubles.
struct Context {
    RTCIntersectContext base;
    RayPacket packet;
};

struct Segments {
    const std::vector<Wall>* walls;
    Vec2d local_origin;
    float padding_m;
    WallTest test;
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

// All 16 rays at once where the processor can, else the four or eight that Embree is at. Rays that
// Embree masks out are tested with the others: a hit is a hit.
void wall_intersect(const RTCIntersectFunctionNArguments* args) {
    const auto& s = *static_cast<const Segments*>(args->geometryUserPtr);
    RayPacket& packet = reinterpret_cast<Context*>(args->context)->packet;
    RTCRayN* rays = RTCRayHitN_RayN(args->rayhit, args->N);
    const std::size_t first = RTCRayN_id(rays, args->N, 0);
    s.test((*s.walls)[args->primID], static_cast<std::int32_t>(args->primID), s.padding_m, first,
           args->N, packet);
    float* far_m = &RTCRayN_tfar(rays, args->N, 0);
    if (args->N == packet_rays) {
        std::copy_n(packet.far_m.data(), packet_rays, far_m);
    } else {
        std::copy_n(&packet.far_m[first], args->N, far_m);
    }
}

class EmbreeTracer final : public RayTracer {
public:
    EmbreeTracer(const Segments& segments, RTCScene scene, double reach_m)
        : segments_(segments),
          scene_(scene),
          reach_m_(reach_m),
          far_m_(static_cast<float>(reach_m) * 1.000001F + segments.padding_m) {
        rtcInitIntersectContext(&context_.base);
        context_.base.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (std::size_t i = 0; i < packet_rays; ++i) {
            rays_.ray.mask[i] = ~0U;
            rays_.ray.id[i] = static_cast<unsigned>(i);
            rays_.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        }
    }

    void set_eyes(const PerRay<Vec2d>& eyes, std::size_t count) override {
        set_eyes(eyes.data(), count);
    }

    void along(const Vec2d* directions, PerRay<std::int32_t>& wall) override {
        set_directions(directions, packet_rays);
        shoot(wall.data(), packet_rays);
    }

    void trace(const Vec2d* eyes, const Vec2d* directions, std::size_t count,
               std::int32_t* wall) override {
        set_eyes(eyes, count);
        set_directions(directions, count);
        shoot(wall, count);
    }

private:
    // Places that no eye takes are masked out, and filled so that no lane meets odd numbers.
    void set_eyes(const Vec2d* eyes, std::size_t count) {
        for (std::size_t i = 0; i < packet_rays; ++i) {
            const Vec2d& eye = eyes[std::min(i, count - 1)];
            const Vec2d local = eye - segments_.local_origin;
            context_.packet.eye_x[i] = eye.x();
            context_.packet.eye_y[i] = eye.y();
            rays_.ray.org_x[i] = static_cast<float>(local.x());
            rays_.ray.org_y[i] = static_cast<float>(local.y());
            valid_[i] = i < count ? -1 : 0;
        }
    }

    void set_directions(const Vec2d* directions, std::size_t count) {
        for (std::size_t i = 0; i < packet_rays; ++i) {
            const Vec2d& d = directions[std::min(i, count - 1)];
            context_.packet.direction_x[i] = d.x();
            context_.packet.direction_y[i] = d.y();
            rays_.ray.dir_x[i] = static_cast<float>(d.x());
            rays_.ray.dir_y[i] = static_cast<float>(d.y());
        }
    }

    void shoot(std::int32_t* wall, std::size_t count) {
        context_.packet.nearest_m.fill(reach_m_);
        context_.packet.wall.fill(-1);
        context_.packet.far_m.fill(far_m_);
        std::fill_n(rays_.ray.tfar, packet_rays, far_m_);
        rtcIntersect16(valid_.data(), scene_, &context_.base, &rays_);
        for (std::size_t i = 0; i < count; ++i) {
            wall[i] = static_cast<std::int32_t>(context_.packet.wall[i]);
        }
    }

    const Segments& segments_;
    RTCScene scene_;
    double reach_m_;
    float far_m_;
    Context context_;
    alignas(64) RTCRayHit16 rays_{};
    alignas(64) PerRay<int> valid_{};
};

}  // namespace

struct EmbreeScene::Impl {
    std::vector<Wall> walls;
    std::unique_ptr<WallEnds> ends;
    Segments segments{};
    double reach_m = 0;
    std::vector<Vec2d> directions;       // of a single eye
    std::vector<Vec2d> fine_directions;  // of a block's eyes, side by side
    RTCScene scene = nullptr;
};

EmbreeScene::EmbreeScene(const std::vector<Wall>& walls, const Box& around, double reach_m,
                         int rays)
    : impl_(std::make_unique<Impl>()) {
    Impl& m = *impl_;
    m.walls = walls;
    m.ends = std::make_unique<WallEnds>(m.walls);
    m.reach_m = reach_m;
    m.fine_directions = circle_directions(rays * static_cast<int>(packet_rays));
    for (std::size_t i = 0; i < m.fine_directions.size(); i += packet_rays) {
        m.directions.push_back(m.fine_directions[i]);
    }
    const Vec2d middle = (around.min + around.max) / 2;
    // Float keeps 24 bits: pad the boxes by what it loses at this size, and by a millimetre.
    const double size = around.size().norm() + reach_m;
    m.segments = {&m.walls, middle, static_cast<float>(1e-3 + 4e-7 * size), wall_test()};
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

std::unique_ptr<RayTracer> EmbreeScene::tracer() const {
    return std::make_unique<EmbreeTracer>(impl_->segments, impl_->scene, impl_->reach_m);
}

void EmbreeScene::first_hits(const Vec2d& eye, View& out) const {
    const Impl& m = *impl_;
    const std::unique_ptr<RayTracer> rays = tracer();
    const std::vector<Vec2d> eyes(packet_rays, eye);
    follow_transitions(
        m.walls, eye, m.directions,
        [&](const std::vector<Vec2d>& d, std::vector<std::int32_t>& wall) {
            const DenormalsOff scope;
            wall.resize(d.size());
            for (std::size_t i = 0; i < d.size(); i += packet_rays) {
                rays->trace(eyes.data(), &d[i], std::min(packet_rays, d.size() - i), &wall[i]);
            }
        },
        out);
}

FieldCounts EmbreeScene::field(const Scanner& scanner, const Grid& grid, const Window& window,
                               const Raster<std::uint8_t>& standable, Raster<float>& vf_rad) const {
    const Impl& m = *impl_;
    const DenormalsOff scope;
    const std::unique_ptr<RayTracer> rays = tracer();
    BlockField block(m.walls, *m.ends, scanner, m.fine_directions, *rays);
    FieldCounts counts;
    PerRay<Vec2d> eyes;
    eyes.fill(Vec2d(0, 0));
    PerRay<std::int64_t> cells{};
    PerRay<double> vf{};
    for (std::int32_t y = window.y_begin; y < window.y_end; y += window_step) {
        for (std::int32_t x = window.x_begin; x < window.x_end; x += window_step) {
            std::size_t count = 0;
            for (std::int32_t iy = y; iy < std::min(y + window_step, window.y_end); ++iy) {
                for (std::int32_t ix = x; ix < std::min(x + window_step, window.x_end); ++ix) {
                    const std::int64_t cell = grid.id(ix, iy);
                    if (standable[idx(cell)] == 0) continue;
                    eyes[count] = grid.centre(cell);
                    cells[count++] = cell;
                }
            }
            if (count == 0) continue;
            block.angles(eyes, count, vf, counts);
            for (std::size_t i = 0; i < count; ++i) {
                vf_rad[idx(cells[i])] = static_cast<float>(vf[i]);
            }
        }
    }
    return counts;
}

void limit_embree_isa(const std::string& isa) { device_settings() = "isa=" + isa; }

int default_rays(double range_max_m, double partition_m) {
    const double wanted = 2 * pi * range_max_m / (3 * partition_m);
    int rays = 128;
    while (rays < 512 && rays < wanted) rays *= 2;
    return rays;
}

}  // namespace vfplan
