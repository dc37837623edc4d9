// Rows that are looked through hold all that is in sight.
#include "engine/tables/sight.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/kernels/scenes.h"

namespace vfplan {
namespace {

constexpr double partition_m = 2;
constexpr double range_m = 30;

// One patch of scattered squares; between them one looks far, and from the rim beyond all walls.
Scene scene_of(const std::vector<Wall>& walls) {
    const Box box = test::bounds_of(walls);
    Layout layout;
    layout.grid.origin = box.min - Vec2d(1, 1);
    layout.grid.nx = static_cast<std::int32_t>(std::ceil(box.size().x())) + 2;
    layout.grid.ny = static_cast<std::int32_t>(std::ceil(box.size().y())) + 2;
    layout.patch_cells = 256;
    layout.tile_cells = 256;
    const SceneOptions options{{0.5, range_m, 88}, KernelKind::exact, 0, false, 0.5, partition_m};
    const Pieces pieces = cut_into_pieces(walls, partition_m);
    const NearWalls near = near_walls(layout, walls, wall_reach_m(range_m, partition_m, 0));
    return {layout, 0, patch_site(walls, pieces, near, 0), options};
}

TEST(Sight, RowsHoldAllThatIsSeen) {
    std::int64_t seen = 0;
    std::int64_t skipped = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        std::mt19937_64 random(seed);
        const std::vector<Wall> walls = test::scattered_squares(6, random);
        const Scene scene = scene_of(walls);
        std::uniform_int_distribution<std::size_t> any(0, walls.size() - 1);
        std::uniform_real_distribution<double> share(0.01, 0.99);
        for (int i = 0; i < 20; ++i) {
            const Wall& w = walls[any(random)];
            const Vec2d e = (w.b - w.a).normalized();
            const Side side = w.free_side[left] ? left : right;
            const Vec2d normal = side == left ? Vec2d(-e.y(), e.x()) : Vec2d(e.y(), -e.x());
            const Vec2d eye = w.a + (w.b - w.a) * share(random) + 2e-4 * normal - scene.origin();
            const Sight sight(scene, eye);
            constexpr double step = 0.5;
            std::vector<Sight::Stretches> rows(160);
            const double y0 = -10 - 2 * step * share(random);
            sight.add_rows(range_m, y0, step, rows);
            for (std::size_t r = 0; r < rows.size(); ++r) {
                for (double x = -10; x < 70; x += step) {
                    const Vec2d p(x + 0.123 * share(random), y0 + static_cast<double>(r) * step);
                    const bool listed = std::any_of(
                        rows[r].begin(), rows[r].end(),
                        [&](const auto& s) { return p.x() >= s.first && p.x() <= s.second; });
                    skipped += !listed;
                    if ((p - eye).norm() > range_m || !sight.sees(p)) continue;
                    ++seen;
                    ASSERT_TRUE(listed) << "seed " << seed << ", eye " << eye.transpose()
                                        << ", place " << p.transpose();
                }
            }
        }
    }
    EXPECT_GT(seen, 20'000);
    EXPECT_GT(skipped, 1'000'000);  // it pays
}

}  // namespace
}  // namespace vfplan
