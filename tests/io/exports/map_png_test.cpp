#include "io/exports/map_png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/exports/map_field.h"
#include "io/exports/map_layout.h"
#include "kernels/error.h"
#include "tests/io/exports/png_pixels.h"

namespace vfplan {
namespace {

using testing::PngPixels;
using testing::read_png;
using Colour = std::array<int, 3>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

int distance(const Colour& a, const Colour& b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]);
}

// 20 x 10 m; the field rises from 0 in the west to 4 in the east; NaN in x 12..16, y 2..6, with
// walls around that hole.
struct Fixture {
    Grid grid{{100, 50}, 0.5, 40, 20};
    Raster<float> field;
    std::vector<Wall> walls;
    MapInput input;

    Fixture() {
        for (std::int64_t i = 0; i < grid.size(); ++i) {
            const Vec2d p = grid.centre(i) - grid.origin;
            const bool hole = p.x() > 12 && p.x() < 16 && p.y() > 2 && p.y() < 6;
            field.push_back(hole ? nan : static_cast<float>(p.x() / 5));
        }
        const Vec2d corner[] = {{112, 52}, {116, 52}, {116, 56}, {112, 56}};
        for (int i = 0; i < 4; ++i) walls.push_back({corner[i], corner[(i + 1) % 4]});
        input.title = "Test site";
        input.subtitle = "3 stations";
        input.grid = &grid;
        input.field_rad = &field;
        input.walls = &walls;
        input.stations = {{{102, 58}, 0}, {{108, 58}, 0}, {{118, 58}, 1}};
        input.links = {{0, 1}};
    }
};

constexpr int size = 800;

struct Picture {
    PngPixels pixels;
    MapLayout layout;

    explicit Picture(const MapInput& input) : pixels(read_png(map_png(input, size))) {
        // Legend entries only matter for the height of the picture, not for the map area.
        layout = map_layout(input, size, 5);
    }
    Colour at(double x_m, double y_m) const {
        return pixels.at(static_cast<int>(layout.x({x_m, y_m})),
                         static_cast<int>(layout.y({x_m, y_m})));
    }
};

TEST(MapPng, HasSignatureAndSize) {
    const Fixture f;
    const std::string png = map_png(f.input, size);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    const Picture p(f.input);
    EXPECT_EQ(p.layout.map_w, size);
    EXPECT_EQ(p.layout.map_h, size / 2);
    EXPECT_GE(p.pixels.width, size);
    EXPECT_LE(p.pixels.width, size + 100);
    EXPECT_GT(p.pixels.height, size / 2 + 100);  // the legend lies below a wide site
    EXPECT_EQ(p.pixels.at(0, 0), (Colour{255, 255, 255}));
}

TEST(MapPng, FieldIsViridisWithNorthUp) {
    const Fixture f;
    const Picture p(f.input);
    const auto expect = [&](double x, double y) {
        const Rgb c = viridis((x - 100) / 5 / 3.95);
        EXPECT_LE(distance(p.at(x, y), {c.r, c.g, c.b}), 8) << x << ' ' << y;
    };
    expect(101, 51);
    expect(110, 54);
    expect(119, 51);
    EXPECT_LT(p.at(101, 51)[1], 40);     // low: dark violet
    EXPECT_GT(p.at(119.5, 51)[1], 200);  // high: yellow
}

TEST(MapPng, CellsWithoutValueAreNeutral) {
    const Fixture f;
    const Picture p(f.input);
    const Colour neutral{no_value_colour.r, no_value_colour.g, no_value_colour.b};
    EXPECT_EQ(p.at(114, 54), neutral);
    EXPECT_EQ(p.at(112.5, 55.5), neutral);
    EXPECT_NE(p.at(114, 58.5), neutral);  // mirrored in y: would be the hole if south were up
}

TEST(MapPng, WallsAreDarkAndClassesDiffer) {
    Fixture f;
    f.walls[1].cls = WallClass::window;
    f.walls[2].cls = WallClass::door;
    f.walls[3].cls = WallClass::obstacle;
    const Picture p(f.input);
    const Colour wall = p.at(114, 52);
    const Colour window = p.at(116, 54);
    const Colour door = p.at(114, 56);
    const Colour obstacle = p.at(112, 54);
    EXPECT_LT(wall[0] + wall[1] + wall[2], 150);
    EXPECT_GT(distance(wall, window), 120);
    EXPECT_GT(distance(wall, door), 120);
    EXPECT_GT(distance(wall, obstacle), 120);
    EXPECT_GT(distance(window, door), 120);
    EXPECT_GT(distance(door, obstacle), 80);
}

TEST(MapPng, StationsAreColouredByNetwork) {
    const Fixture f;
    const Picture p(f.input);
    const Colour main = p.at(102, 58);
    EXPECT_EQ(main, p.at(108, 58));
    EXPECT_GT(distance(main, p.at(118, 58)), 150);
    for (int i = 0; i <= 20; ++i) {  // stands out on every colour of the field
        const Rgb c = viridis(i / 20.0);
        EXPECT_GT(distance(main, {c.r, c.g, c.b}), 150);
    }
    Fixture bare;
    bare.input.links.clear();
    EXPECT_GT(distance(p.at(105, 58), Picture(bare.input).at(105, 58)), 60);
}

TEST(MapPng, UncoveredWallIsRed) {
    Fixture f;
    f.input.uncovered = {{{112, 52}, {116, 52}}};
    const Colour c = Picture(f.input).at(114, 52);
    EXPECT_GT(c[0], 200);
    EXPECT_LT(c[1] + c[2], 80);
}

TEST(MapPng, EqualInputGivesEqualBytes) {
    const Fixture f;
    const Fixture g;
    EXPECT_EQ(map_png(f.input, size), map_png(g.input, size));
    Fixture other;
    other.input.stations.pop_back();
    EXPECT_NE(map_png(f.input, size), map_png(other.input, size));
}

TEST(MapPng, EmptyPlanAndEmptySiteWork) {
    EXPECT_GT(read_png(map_png({}, size)).width, size);
    Fixture f;
    f.input.stations.clear();
    f.input.links.clear();
    EXPECT_GT(read_png(map_png(f.input, size)).width, size);
    for (float& v : f.field) v = nan;
    EXPECT_GT(read_png(map_png(f.input, size)).width, size);
    f.input.field_rad = nullptr;
    f.input.grid = nullptr;
    EXPECT_GT(read_png(map_png(f.input, size)).width, size);
}

TEST(MapPng, OddTextAndLinksToNowhereDoNoHarm) {
    Fixture f;
    f.input.title = std::string("M\xC3\xBCnchen \xFF\xC3 broken\nname ") + std::string(400, 'x');
    f.input.links.push_back({0, 99});
    f.input.links.push_back({-1, 0});
    EXPECT_GT(read_png(map_png(f.input, size)).width, size);
}

TEST(MapPng, ElongatedSitesStayReadable) {
    for (const auto& [nx, ny] : {std::pair{4000, 2}, std::pair{2, 4000}}) {
        const Grid grid{{0, 0}, 1, nx, ny};
        const Raster<float> field(static_cast<std::size_t>(grid.size()), 1.0F);
        MapInput input;
        input.grid = &grid;
        input.field_rad = &field;
        const MapLayout l = map_layout(input, size, 1);
        EXPECT_GE(std::min(l.map_w, l.map_h), size / 13);
        EXPECT_EQ(std::max(l.map_w, l.map_h), size);
        EXPECT_GT(read_png(map_png(input, size)).width, 0);
    }
}

TEST(MapPng, ShortFieldIsRefused) {
    Fixture f;
    f.field.pop_back();
    EXPECT_THROW(map_png(f.input, size), IoError);
}

TEST(MapField, SmallCellsAreAveragedAndNoneIsLost) {
    const Grid grid{{0, 0}, 0.1, 100, 100};
    Raster<float> field(static_cast<std::size_t>(grid.size()));
    for (std::size_t i = 0; i < field.size(); ++i) field[i] = i % 2 == 0 ? 1.0F : 3.0F;
    const auto pixels = field_pixels(grid, field, 4, {{0, 10}, 1, 10, 10});
    const Rgb c = viridis(0.5);
    for (const std::uint32_t v : pixels) {
        EXPECT_NEAR(static_cast<int>(v >> 16), c.r, 2);
        EXPECT_NEAR(static_cast<int>(v >> 8 & 0xFFU), c.g, 2);
    }
}

}  // namespace
}  // namespace vfplan
