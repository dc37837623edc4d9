// Fields: many cells at once must see what one eye sees.
#include <gtest/gtest.h>

#include "kernels/block_field.h"
#include "kernels/index.h"
#include "kernels/locator.h"
#include "kernels/wall_test.h"
#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

struct World {
    std::vector<Wall> walls;
    Box box;
    Grid grid;
    Raster<std::uint8_t> standable;

    World(std::vector<Wall> w, double cell_m, const Vec2d& shift = {0, 0}) : walls(std::move(w)) {
        box = test::bounds_of(walls);
        box.min -= Vec2d(12, 12);
        box.max += Vec2d(12, 12);
        grid.origin = box.min + shift;
        grid.cell_m = cell_m;
        grid.nx = static_cast<std::int32_t>(box.size().x() / cell_m) - 1;
        grid.ny = static_cast<std::int32_t>(box.size().y() / cell_m) - 1;
        standable.assign(idx(grid.size()), 1);
        for (std::int64_t c = 0; c < grid.size(); ++c) {
            for (const Wall& wall : walls) {
                const Vec2d e = wall.b - wall.a;
                const Vec2d p = grid.centre(c) - wall.a;
                const double t = std::clamp(p.dot(e) / e.squaredNorm(), 0.0, 1.0);
                if ((p - e * t).norm() < 1e-3) standable[idx(c)] = 0;  // on a wall
            }
        }
    }
};

Raster<float> field(const ViewKernel& kernel, const Scanner& scanner, const World& w,
                    std::int32_t step = 1 << 20) {
    Raster<float> vf(idx(w.grid.size()), -1.0F);
    FieldCounts counts;
    for (std::int32_t y = 0; y < w.grid.ny; y += step) {
        for (std::int32_t x = 0; x < w.grid.nx; x += step) {
            const Window window{x, y, std::min(w.grid.nx, x + step), std::min(w.grid.ny, y + step)};
            counts += kernel.field(scanner, w.grid, window, w.standable, vf);
        }
    }
    EXPECT_EQ(counts.cells, std::count(w.standable.begin(), w.standable.end(), 1));
    EXPECT_GT(counts.steps, counts.packets);
    return vf;
}

World squares(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    return World(test::scattered_squares(6, random), 1);
}

// Every third wall occludes only.
World squares_with_fences(std::uint64_t seed) {
    World w = squares(seed);
    for (std::size_t i = 0; i < w.walls.size(); i += 3) w.walls[i].scanned = false;
    return w;
}

const std::vector<Scanner>& scanners() {
    static const std::vector<Scanner> all = {{0.6, 600, 90}, {0, 1e4, 90},  {3, 25, 90},
                                             {0.6, 12, 90},  {0.6, 40, 55}, {5, 9, 20}};
    return all;
}

TEST(ExactField, SumsWhatOneEyeSees) {
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        for (const World& w : {squares(seed), squares_with_fences(seed)}) {
            for (const Scanner& s : scanners()) {
                const ExactScene scene(w.walls, w.box, s.range_max_m);
                const Raster<float> vf = field(scene, s, w);
                double total = 0;
                for (std::int64_t c = 0; c < w.grid.size(); ++c) {
                    if (w.standable[idx(c)] == 0) {
                        ASSERT_EQ(vf[idx(c)], -1.0F);
                        continue;
                    }
                    const double want =
                        view_angle_rad(test::look(scene, w.walls, s, w.grid.centre(c)));
                    ASSERT_NEAR(static_cast<double>(vf[idx(c)]), want, 6e-7)
                        << w.grid.centre(c).transpose() << " range " << s.range_max_m;
                    total += want;
                }
                EXPECT_GT(total, 0);
            }
        }
    }
}

TEST(ExactField, ClosedRoomIsAWholeTurnAndOpenGroundNothing) {
    const World room(test::rectangle({0, 0}, {10, 8}), 1, {0.3, 0.4});
    const ExactScene scene(room.walls, room.box, 100);
    const Raster<float> vf = field(scene, {0, 100, 90}, room);
    for (std::int64_t c = 0; c < room.grid.size(); ++c) {
        const Vec2d eye = room.grid.centre(c);
        const bool inside = eye.x() > 0 && eye.x() < 10 && eye.y() > 0 && eye.y() < 8;
        if (inside) {
            EXPECT_EQ(vf[idx(c)], static_cast<float>(2 * pi));
        } else {
            EXPECT_LT(vf[idx(c)], static_cast<float>(pi));
        }
    }
    const ExactScene near(room.walls, room.box, 2);
    const Raster<float> far_off = field(near, {0, 2, 90}, room);
    EXPECT_EQ(far_off[0], 0.0F);
}

class FieldKernels : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Both, FieldKernels, testing::Values("exact", "embree"));

TEST_P(FieldKernels, WindowsDoNotMatter) {
    for (const World& w : {squares(5), squares_with_fences(6)}) {
        for (const Scanner& s : {Scanner{0.6, 600, 90}, Scanner{3, 25, 70}}) {
            const auto kernel = test::kernel_named(GetParam(), w.walls, w.box, s.range_max_m, 64);
            const Raster<float> whole = field(*kernel, s, w);
            EXPECT_EQ(whole, field(*kernel, s, w, 4));
            EXPECT_EQ(whole, field(*kernel, s, w, 20));
        }
    }
}

// Cells on the very lines of the triangulation: which triangle they belong to must not depend on
// where the search for it came from.
TEST_P(FieldKernels, WindowsDoNotMatterOnEdges) {
    std::vector<Wall> walls;
    for (int y = 0; y < 5; ++y) {
        for (int x = 0; x < 5; ++x) {
            const Vec2d lo(8 * x, 8 * y);
            for (const Wall& wall : test::rectangle(lo, lo + Vec2d(3, 3))) walls.push_back(wall);
        }
    }
    const World w(walls, 0.5, {-0.25, -0.25});
    const auto kernel = test::kernel_named(GetParam(), w.walls, w.box, 60, 64);
    EXPECT_EQ(field(*kernel, {0.6, 60, 90}, w), field(*kernel, {0.6, 60, 90}, w, 4));
}

// The slow, obvious tracer, with the kernel's own arithmetic of one ray and one wall.
class EveryWall final : public RayTracer {
public:
    EveryWall(const std::vector<Wall>& walls, double reach_m) : walls_(walls), reach_m_(reach_m) {}
    void set_eyes(const PerRay<Vec2d>& eyes, std::size_t) override { eyes_ = eyes; }
    void along(const Vec2d* directions, PerRay<std::int32_t>& wall) override {
        trace(eyes_.data(), directions, packet_rays, wall.data());
    }
    void trace(const Vec2d* eyes, const Vec2d* directions, std::size_t count,
               std::int32_t* wall) override {
        for (std::size_t i = 0; i < count; ++i) {
            double nearest = reach_m_;
            wall[i] = -1;
            for (std::size_t k = 0; k < walls_.size(); ++k) {
                const Vec2d e = walls_[k].b - walls_[k].a;
                const Vec2d to_a = walls_[k].a - eyes[i];
                double den = cross(directions[i], e);
                double u = cross(to_a, directions[i]);
                double t = cross(to_a, e);
                if (den < 0) {
                    den = -den;
                    u = -u;
                    t = -t;
                }
                if (den == 0 || u < 0 || u > den || t <= 0 || !(t / den < nearest)) continue;
                nearest = t / den;
                wall[i] = static_cast<std::int32_t>(k);
            }
        }
    }

private:
    const std::vector<Wall>& walls_;
    double reach_m_;
    PerRay<Vec2d> eyes_;
};

TEST(EmbreeField, FindsWhatTestingEveryWallFinds) {
    for (const World& w : {squares(7), squares_with_fences(8)}) {
        for (const Scanner& s : {Scanner{0.6, 600, 90}, Scanner{2, 20, 90}, Scanner{0.6, 40, 60}}) {
            constexpr int rays = 32;
            const EmbreeScene scene(w.walls, w.box, s.range_max_m, rays);
            const Raster<float> vf = field(scene, s, w);
            EveryWall tracer(w.walls, s.range_max_m);
            const WallEnds ends(w.walls);
            const std::vector<Vec2d> directions = circle_directions(16 * rays);
            BlockField block(w.walls, ends, s, directions, tracer);
            FieldCounts counts;
            for (std::int32_t y = 0; y < w.grid.ny; y += 4) {
                for (std::int32_t x = 0; x < w.grid.nx; x += 4) {
                    PerRay<Vec2d> eyes;
                    PerRay<double> want;
                    std::vector<std::int64_t> cells;
                    for (std::int32_t iy = y; iy < std::min(y + 4, w.grid.ny); ++iy) {
                        for (std::int32_t ix = x; ix < std::min(x + 4, w.grid.nx); ++ix) {
                            if (w.standable[idx(w.grid.id(ix, iy))] == 0) continue;
                            eyes[cells.size()] = w.grid.centre(w.grid.id(ix, iy));
                            cells.push_back(w.grid.id(ix, iy));
                        }
                    }
                    if (cells.empty()) continue;
                    std::fill(eyes.begin() + static_cast<std::ptrdiff_t>(cells.size()), eyes.end(),
                              eyes[0]);
                    block.angles(eyes, cells.size(), want, counts);
                    for (std::size_t i = 0; i < cells.size(); ++i) {
                        ASSERT_EQ(vf[idx(cells[i])], static_cast<float>(want[i]));
                    }
                }
            }
        }
    }
}

double mean_error(const World& w, const Scanner& s, int rays) {
    const ExactScene exact(w.walls, w.box, s.range_max_m);
    const EmbreeScene embree(w.walls, w.box, s.range_max_m, rays);
    const Raster<float> want = field(exact, s, w);
    const Raster<float> got = field(embree, s, w);
    double sum = 0;
    for (std::size_t i = 0; i < want.size(); ++i) {
        sum += std::abs(static_cast<double>(got[i]) - static_cast<double>(want[i]));
    }
    return sum / static_cast<double>(want.size());
}

TEST(EmbreeField, ComesCloserToTheExactOneWithMoreRays) {
    for (const Scanner& s : scanners()) {
        for (const World& w : {squares(9), squares_with_fences(9)}) {
            const double coarse = mean_error(w, s, 32);
            const double fine = mean_error(w, s, 1024);
            // What stands in front is always observed only where all walls are scanned, at any
            // incidence.
            const bool plain = w.walls[0].scanned && s.max_incidence_deg >= 90;
            EXPECT_LE(coarse, plain ? 0.03 : 0.1) << "range " << s.range_max_m;
            EXPECT_LE(fine, plain ? 1e-4 : 3e-3) << "range " << s.range_max_m;
            EXPECT_LE(fine, coarse / 4);
        }
    }
}

// Ends of walls must be found without a ray on them, and rays be spared where walls go on.
TEST(EmbreeField, WallsOfOneBuildingNeedNoRays) {
    const World w(test::rectangle({0, 0}, {20, 6}), 2, {0.1, 0.1});
    const Scanner s{0, 1000, 90};
    const ExactScene exact(w.walls, w.box, s.range_max_m);
    const EmbreeScene embree(w.walls, w.box, s.range_max_m, 64);
    const Raster<float> want = field(exact, s, w);
    Raster<float> got(want.size(), -1.0F);
    const FieldCounts counts =
        embree.field(s, w.grid, {0, 0, w.grid.nx, w.grid.ny}, w.standable, got);
    for (std::size_t i = 0; i < want.size(); ++i) EXPECT_NEAR(got[i], want[i], 1e-6);
    // Outside, one ray past each end of the building; inside none.
    EXPECT_LE(counts.walls, 2 * counts.cells);
    EXPECT_EQ(counts.steps, 64 * counts.cells + counts.walls);
}

// An eye on a vertex stands in a fan of triangles, whichever of them the walk comes to first.
TEST(TriangleLocator, TheWayDoesNotMatter) {
    std::mt19937_64 random(4);
    const std::vector<Wall> walls = test::scattered_squares(4, random);
    const Box box = test::bounds_of(walls);
    const Triangulation mesh = triangulate(walls, box, 20);
    const TriangleLocator locator(mesh, box);
    const auto triangles = static_cast<std::int32_t>(mesh.triangles.size());
    for (std::size_t v = 0; v < 12; ++v) {
        const Vec2d middle = (walls[v].a + walls[v].b) / 2;
        for (const Vec2d& eye : {walls[v].a, middle, Vec2d(middle + Vec2d(0.3, 0.7))}) {
            const std::int32_t found = locator.locate(eye);
            EXPECT_GE(found, 0);
            for (std::int32_t from = 0; from < triangles; ++from) {
                ASSERT_EQ(locator.locate(eye, from), found) << eye.transpose() << " from " << from;
            }
        }
    }
    EXPECT_EQ(locator.locate({1e5, 1e4}), -1);
}

}  // namespace
}  // namespace vfplan
