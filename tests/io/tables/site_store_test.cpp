#include "io/tables/site_store.h"
#include "kernels/index.h"

#include <gtest/gtest.h>

#include <random>

#include "io/files.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

// 150 x 100 cells in patches of 32, random walls.
struct Stored {
    test::TemporaryFile file{"site.h5"};
    Layout layout;
    SiteFacts facts;
    std::vector<Wall> walls;
    Pieces pieces;
    NearWalls near;
    Raster<std::uint8_t> standable;  // of the whole grid
    std::vector<CellBits> bits;

    explicit Stored(std::uint64_t seed) {
        std::mt19937_64 random(seed);
        std::uniform_real_distribution<double> x(0, 148);
        std::uniform_real_distribution<double> y(0, 97);
        std::uniform_real_distribution<double> step(-9, 9);
        Grid grid;
        grid.origin = {-0.25, -0.5};
        grid.nx = 150;
        grid.ny = 100;
        layout = {grid, 32, 64};
        for (int i = 0; i < 400; ++i) {
            Wall w;
            w.a = {x(random), y(random)};
            w.b = w.a + Vec2d(step(random), step(random));
            w.cls = static_cast<WallClass>(random() % 4);
            w.scanned = random() % 5 != 0;
            w.free_side[left] = random() % 3 != 0;
            w.free_side[right] = random() % 3 != 0;
            walls.push_back(w);
        }
        pieces = cut_into_pieces(walls, 2);
        near = near_walls(layout, walls, 7);
        standable.resize(idx(grid.size()));
        for (auto& cell : standable) cell = random() % 3 != 0;
        for (std::int64_t p = 0; p < layout.patches(); ++p) {
            const Window w = layout.patch_window(p);
            bits.emplace_back((idx(w.size()) + 7) / 8, 0);
            std::size_t i = 0;
            for (std::int32_t iy = w.y_begin; iy < w.y_end; ++iy) {
                for (std::int32_t ix = w.x_begin; ix < w.x_end; ++ix, ++i) {
                    if (standable[idx(grid.id(ix, iy))] == 0) continue;
                    bits.back()[i / 8] =
                        static_cast<std::uint8_t>(bits.back()[i / 8] | 1U << i % 8);
                }
            }
        }
        facts = {{5e5, 4e6}, "PROJCS[\"x\"]",     R"({"site":1})",  12,      400, pieces.size(),
                 777,        {{0, 0}, {148, 97}}, {{1, 2}, {3, 4}}, {{5, 6}}};
        write_site_store(file.path(), "the key", layout, facts, walls, pieces, near, bits);
    }
};

void expect_equal(const Wall& a, const Wall& b) {
    EXPECT_EQ(a.a, b.a);
    EXPECT_EQ(a.b, b.b);
    EXPECT_EQ(a.cls, b.cls);
    EXPECT_EQ(a.scanned, b.scanned);
    EXPECT_EQ(a.free_side[left], b.free_side[left]);
    EXPECT_EQ(a.free_side[right], b.free_side[right]);
}

TEST(SiteStore, FactsComeBackForTilesOfAnySize) {
    const Stored s(1);
    for (const std::int64_t tile : {64, 100, 1024}) {
        const SiteStore store(s.file.path(), tile);
        EXPECT_EQ(store.layout().tile_cells, tile);
        EXPECT_EQ(store.layout().patch_cells, 32);
        EXPECT_EQ(store.layout().grid.nx, 150);
        EXPECT_EQ(store.layout().grid.ny, 100);
        EXPECT_EQ(store.layout().grid.cell_m, 1);
        EXPECT_EQ(store.layout().grid.origin, s.layout.grid.origin);
        const SiteFacts& f = store.facts();
        EXPECT_EQ(f.origin, s.facts.origin);
        EXPECT_EQ(f.crs_wkt, s.facts.crs_wkt);
        EXPECT_EQ(f.summary, s.facts.summary);
        EXPECT_EQ(f.buildings, 12);
        EXPECT_EQ(f.walls, 400);
        EXPECT_EQ(f.pieces, s.pieces.size());
        EXPECT_EQ(f.free_cells, 777);
        EXPECT_EQ(f.extent.min, s.facts.extent.min);
        EXPECT_EQ(f.extent.max, s.facts.extent.max);
    }
    EXPECT_EQ(h5::Reader(s.file.path()).text("/", "key"), "the key");
}

TEST(SiteStore, WallsAndPiecesComeBack) {
    const Stored s(2);
    const SiteStore store(s.file.path(), 64);
    const std::vector<Wall> walls = store.all_walls();
    ASSERT_EQ(walls.size(), s.walls.size());
    for (std::size_t i = 0; i < walls.size(); ++i) expect_equal(walls[i], s.walls[i]);
    const Pieces pieces = store.all_pieces(walls);
    ASSERT_EQ(pieces.size(), s.pieces.size());
    for (std::int64_t p = 0; p < pieces.size(); ++p) {
        EXPECT_EQ(pieces.place(p).wall, s.pieces.place(p).wall);
        EXPECT_EQ(pieces.place(p).side, s.pieces.place(p).side);
        EXPECT_EQ(pieces.length_m(p), s.pieces.length_m(p));
    }
}

TEST(SiteStore, APatchHasTheWallsAroundItWithTheirPieces) {
    const Stored s(3);
    const SiteStore store(s.file.path(), 64);
    std::size_t met = 0;
    for (std::int64_t p = 0; p < s.layout.patches(); ++p) {
        const PatchSite site = store.patch(p);
        const auto from = idx(s.near.begin[idx(p)]);
        const auto count = idx(s.near.begin[idx(p) + 1]) - from;
        EXPECT_EQ(store.has_walls(p), count > 0);
        ASSERT_EQ(site.walls.size(), count);
        for (std::size_t i = 0; i < count; ++i, ++met) {
            const std::int32_t w = site.number[i];
            EXPECT_EQ(w, s.near.wall[from + i]);
            expect_equal(site.walls[i], s.walls[idx(w)]);
            for (const Side side : {left, right}) {
                const std::int32_t n = s.pieces.count(w, side);
                EXPECT_EQ(site.first[side][i], n > 0 ? s.pieces.first(w, side) : -1);
                if (n > 0) {
                    EXPECT_EQ(site.count[i], n);
                }
            }
        }
    }
    EXPECT_GT(met, s.walls.size());  // walls near a border are in several
}

TEST(SiteStore, CellsToStandInComeBackByPatchAndByWindow) {
    const Stored s(4);
    const SiteStore store(s.file.path(), 64);
    const Grid& grid = s.layout.grid;
    const auto expect = [&](const Window& w, const Raster<std::uint8_t>& got) {
        ASSERT_EQ(got.size(), idx(w.size()));
        std::size_t i = 0;
        for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
            for (std::int32_t x = w.x_begin; x < w.x_end; ++x, ++i) {
                ASSERT_EQ(got[i], s.standable[idx(grid.id(x, y))]) << x << ", " << y;
            }
        }
    };
    for (std::int64_t p = 0; p < s.layout.patches(); ++p) {
        expect(s.layout.patch_window(p), store.standable(p));
    }
    for (const Window& w : {Window{0, 0, 150, 100}, Window{31, 31, 33, 33}, Window{5, 60, 149, 99},
                            Window{149, 99, 150, 100}}) {
        expect(w, store.standable(w));
    }
}

TEST(SiteStore, EqualSitesGiveEqualBytes) {
    const Stored a(5);
    const std::string bytes = read_text(a.file.path());
    write_site_store(a.file.path(), "the key", a.layout, a.facts, a.walls, a.pieces, a.near,
                     a.bits);
    EXPECT_EQ(read_text(a.file.path()), bytes);
}

TEST(SiteStore, ASiteWithoutWallsComesBack) {
    const test::TemporaryFile file("empty.h5");
    Layout layout;
    layout.grid.nx = layout.grid.ny = 10;
    layout.patch_cells = 32;
    layout.tile_cells = 64;
    write_site_store(file.path(), "k", layout, {}, {}, {}, near_walls(layout, {}, 5),
                     {CellBits(13, 0xff)});
    const SiteStore store(file.path(), 64);
    EXPECT_FALSE(store.has_walls(0));
    EXPECT_TRUE(store.patch(0).walls.empty());
    EXPECT_TRUE(store.all_walls().empty());
    EXPECT_EQ(store.standable(0), Raster<std::uint8_t>(100, 1));
}

}  // namespace
}  // namespace vfplan
