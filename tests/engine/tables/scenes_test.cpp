// Scenes of patches see what a scene of the whole site sees.
#include "engine/tables/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "kernels/exact_scene.h"
#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

using test::wall;

// Scattered squares, lone walls and a few walls much longer than a patch, in patches of 32 cells.
struct City {
    std::vector<Wall> walls;
    Layout layout;
    Pieces pieces;
    SceneOptions options;
    NearWalls near;
    ExactScene whole;

    City(std::uint64_t seed, double range_m)
        : walls(made(seed)),
          layout(laid_out(walls)),
          pieces(cut_into_pieces(walls, partition_m)),
          options{{0.5, range_m, 88}, KernelKind::exact, 0, false, 0.5, partition_m},
          near(near_walls(layout, walls, wall_reach_m(range_m, partition_m, 0))),
          whole(walls, test::bounds_of(walls), range_m) {}

    static constexpr double partition_m = 2;
    static std::vector<Wall> made(std::uint64_t seed) {
        std::mt19937_64 random(seed);
        const std::vector<Wall> out = test::scattered_squares(11, random);
        std::vector<Wall> all;
        for (std::size_t i = 0; i < out.size(); ++i) {  // some squares are missing
            if (i / 4 % 5 != 3) all.push_back(out[i]);
        }
        const auto add = [&](double x0, double y0, double x1, double y1) {
            all.push_back(wall({x0, y0}, {x1, y1}));
        };
        add(-3, -3, 113, -3.5);  // all along the south
        add(113, -3.5, 112, 112);
        add(-2, 29.8, 112, 30.2);  // right across, between the squares
        add(69.9, 31, 70.1, 111);
        add(-2.5, 111.5, 60, 112);
        return all;
    }
    static Layout laid_out(const std::vector<Wall>& walls) {
        Grid grid;
        const Box box = test::bounds_of(walls);
        grid.origin = box.min - Vec2d(1, 1);
        grid.nx = static_cast<std::int32_t>(std::ceil(box.size().x())) + 2;
        grid.ny = static_cast<std::int32_t>(std::ceil(box.size().y())) + 2;
        return {grid, 32, 64};
    }
    PatchSite patch(std::int64_t p) const { return patch_site(walls, pieces, near, p); }
    // As one scene of all walls in the site's own frame sees it.
    Scene::Look by_the_whole(const Vec2d& eye) const {
        const View v = test::look(whole, walls, options.scanner, eye);
        Scene::Look out;
        out.vf_rad = view_angle_rad(v);
        out.row = coverage_row(walls, pieces, eye, v, options.visible_fraction);
        return out;
    }
};

void expect_equal(const City& city, const Scene::Look& got, const Scene::Look& want,
                  const Vec2d& eye) {
    EXPECT_NEAR(got.vf_rad, want.vf_rad, 1e-9) << eye.transpose();
    ASSERT_EQ(got.row.size(), want.row.size()) << eye.transpose();
    ASSERT_EQ(got.length_m.size(), want.row.size());
    for (std::size_t i = 0; i < want.row.size(); ++i) {
        ASSERT_EQ(got.row[i].piece, want.row[i].piece) << eye.transpose();
        EXPECT_NEAR(got.row[i].fraction, want.row[i].fraction, 1e-6);
        EXPECT_NEAR(got.row[i].angle_rad, want.row[i].angle_rad, 1e-6);
        EXPECT_EQ(got.length_m[i], city.pieces.length_m(want.row[i].piece));
    }
}

class ScenesOfPatches : public ::testing::TestWithParam<double> {};

// Eyes beside the borders of patches, on either side, and anywhere.
TEST_P(ScenesOfPatches, SeeWhatTheWholeSees) {
    std::size_t seen = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const City city(seed, GetParam());
        Scenes scenes(
            city.layout, [&](std::int64_t p) { return city.patch(p); }, city.options, 4);
        EXPECT_GT(city.layout.patches(), 8);
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> anywhere(0, 108);
        std::uniform_real_distribution<double> beside(-1e-3, 1e-3);
        for (int i = 0; i < 150; ++i) {
            Vec2d eye(anywhere(random), anywhere(random));
            if (i % 3 != 0) {
                const double border = 32.0 * (1 + static_cast<double>(random() % 3));
                const int axis = i % 3 - 1;
                eye[axis] = city.layout.grid.origin[axis] + border + beside(random);
            }
            const Scene::Look got = scenes.look(eye);
            expect_equal(city, got, city.by_the_whole(eye), eye);
            seen += got.row.size();
        }
    }
    EXPECT_GT(seen, 1000U);
}

// Rescue looks from points a little beyond the patch whose scene it asks.
TEST_P(ScenesOfPatches, ServeEyesALittleBeyondThem) {
    const City city(4, GetParam());
    const double margin = eye_margin_m(City::partition_m);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> along(0, 32);
    for (std::int64_t p = 0; p < city.layout.patches(); ++p) {
        const Scene scene(city.layout, p, city.patch(p), city.options);
        const Vec2d lo = city.layout.patch_origin(p);
        for (const double off : {-0.999 * margin, -0.3, 0.3}) {
            for (const int axis : {0, 1}) {
                Vec2d eye = lo;
                eye[axis] += off;
                eye[1 - axis] += along(random);
                if (!test::bounds_of(city.walls).contains(eye)) continue;
                expect_equal(city, scene.look(eye), city.by_the_whole(eye), eye);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Ranges, ScenesOfPatches, ::testing::Values(6.0, 17.0, 60.0),
                         [](const auto& i) {
                             return "of_" + std::to_string(static_cast<int>(i.param)) + "_m";
                         });

TEST(Scenes, RowsComeInTheOrderOfTheirEyesForAnyThreadsAndMemory) {
    const City city(5, 20);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> anywhere(0, 108);
    std::vector<Vec2d> eyes;
    for (int i = 0; i < 300; ++i) eyes.emplace_back(anywhere(random), anywhere(random));
    const auto rows = [&](int threads, int kept) {
        Scenes scenes(
            city.layout, [&](std::int64_t p) { return city.patch(p); }, city.options, kept);
        return scenes.overlap_rows(Threads(threads), eyes);
    };
    const auto one = rows(1, 100);
    for (const auto& [threads, kept] : {std::pair(1, 1), std::pair(3, 2), std::pair(2, 100)}) {
        const auto other = rows(threads, kept);
        for (std::size_t i = 0; i < eyes.size(); ++i) {
            const SeenRow a = one[i].seen();
            const SeenRow b = other[i].seen();
            ASSERT_EQ(a.piece.size(), b.piece.size());
            EXPECT_EQ(one[i].total().length_m, other[i].total().length_m);
            for (std::size_t k = 0; k < a.piece.size(); ++k) {
                EXPECT_EQ(a.piece[k], b.piece[k]);
                EXPECT_EQ(a.angle_rad[k], b.angle_rad[k]);
            }
        }
    }
}

// Of a patch's field, in a part of the patch, against a scene of the whole site.
std::vector<double> errors_in(const City& city, const Window& patch, const Window& part,
                              const Raster<float>& vf) {
    std::vector<double> out;
    for (std::int32_t y = part.y_begin; y < part.y_end; ++y) {
        for (std::int32_t x = part.x_begin; x < part.x_end; ++x) {
            const Vec2d eye =
                city.layout.grid.centre(city.layout.grid.id(patch.x_begin + x, patch.y_begin + y));
            const auto i = static_cast<std::size_t>(y * (patch.x_end - patch.x_begin) + x);
            out.push_back(std::abs(static_cast<double>(vf[i]) - city.by_the_whole(eye).vf_rad));
        }
    }
    return out;
}

TEST(Scenes, TheFieldIsWhatIsSeenFromTheCentres) {
    for (const KernelKind kernel : {KernelKind::exact, KernelKind::embree}) {
        City city(6, 15);
        city.options.kernel = kernel;
        city.options.rays = 2048;
        for (std::int64_t p = 0; p < city.layout.patches(); p += 3) {
            const Scene scene(city.layout, p, city.patch(p), city.options);
            const Window w = city.layout.patch_window(p);
            const Raster<std::uint8_t> all(static_cast<std::size_t>(w.size()), 1);
            Raster<float> vf(all.size(), -1);
            const Window part{0, 0, std::min(16, w.x_end - w.x_begin),
                              std::min(16, w.y_end - w.y_begin)};
            scene.field(part, all, vf);
            const std::vector<double> errors = errors_in(city, w, part, vf);
            EXPECT_LT(*std::max_element(errors.begin(), errors.end()),
                      kernel == KernelKind::exact ? 1e-5 : 0.05)
                << name_of(kernel);
        }
    }
}

// 16 rays miss what stands between them; where that is too much more are taken.
TEST(Scenes, RaysAreAsManyAsTheFieldNeeds) {
    City city(7, 15);
    city.options.kernel = KernelKind::embree;
    city.options.rays = 16;
    const auto worst_mean = [&](bool more_rays) {
        city.options.more_rays = more_rays;
        double worst = 0;
        for (std::int64_t p = 0; p < city.layout.patches(); ++p) {
            const Scene scene(city.layout, p, city.patch(p), city.options);
            const Window w = city.layout.patch_window(p);
            const Window all{0, 0, w.x_end - w.x_begin, w.y_end - w.y_begin};
            const Raster<std::uint8_t> standable(static_cast<std::size_t>(w.size()), 1);
            Raster<float> vf(standable.size(), -1);
            scene.take_rays_enough(standable);
            scene.field(all, standable, vf);
            const std::vector<double> errors = errors_in(city, w, all, vf);
            worst = std::max(worst, std::accumulate(errors.begin(), errors.end(), 0.0) /
                                        static_cast<double>(errors.size()));
        }
        return worst;
    };
    EXPECT_GT(worst_mean(false), 5e-3);
    EXPECT_LT(worst_mean(true), 5e-3);
}

}  // namespace
}  // namespace vfplan
