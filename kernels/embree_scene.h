// The ray kernel: walls as Embree geometry, rays in packets, wall ends found analytically.
//
// Each wall is one primitive of a user geometry: Embree's boxes (the wall extruded to a slab)
// find which walls a ray may meet, and the meeting itself is computed here in double precision,
// nearest first, lowest id among equals. That gives the same bits under SSE2, AVX2 and AVX-512;
// with one wall against 16 rays in SIMD it costs no more than Embree's own quads.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernels/ray_tracer.h"
#include "kernels/view.h"

namespace vfplan {

class EmbreeScene final : public ViewKernel {
public:
    // `rays`: how many directions are looked at before transitions between walls are followed
    // up; a power of two, at least 16. Things thinner than 2 pi / rays may be missed.
    EmbreeScene(const std::vector<Wall>& walls, const Box& around, double reach_m, int rays);
    ~EmbreeScene() override;
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    void first_hits(const Vec2d& eye, View& out) const override;
    FieldCounts field(const Scanner& scanner, const Grid& grid, const Window& window,
                      const Raster<std::uint8_t>& standable, Raster<float>& vf_rad) const override;

    // The bare rays; one per thread. Valid as long as the scene is.
    std::unique_ptr<RayTracer> tracer() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// See limit_isa(). REQUIRES: one of its names.
void limit_embree_isa(const std::string& isa);

// How many directions keep neighbouring rays within three pieces of each other at full range: 128
// to 512, where wall ends take over.
int default_rays(double range_max_m, double partition_m);

}  // namespace vfplan
