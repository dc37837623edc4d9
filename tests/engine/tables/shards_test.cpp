// Phases of shards: resumable, mended, and the same for tiles of any side.
#include "engine/tables/shards.h"

#include <gtest/gtest.h>

#include <atomic>
#include <tuple>

#include "engine/tables/site.h"
#include "engine/tables/standable.h"
#include "io/files.h"
#include "io/h5_reader.h"
#include "kernels/error.h"
#include "tests/engine/tables/ground.h"

namespace vfplan {
namespace {

using test::box_ring;
using test::CandidateResult;
using test::Job;
using test::ring_of;
using test::World;

// Streets between blocks of several shapes, with a courtyard: 150 x 110 cells.
World blocks(std::int64_t tile_cells) {
    World::Setting s;
    s.scanner = {0.5, 12, 85};
    s.tile_cells = tile_cells;
    s.threshold_rad = 0.4;
    std::vector<Ring> rings = {box_ring(0, 0, 150, 110), box_ring(60, 40, 90, 70),
                               box_ring(66, 46, 84, 64)};  // the courtyard is free again
    for (const double x : {10.0, 31.5, 97.25, 121.0}) {
        for (const double y : {8.0, 33.0, 61.5, 88.0}) {
            rings.push_back(box_ring(x, y, x + 14.5, y + 11 + 3 * (x < 50)));
        }
    }
    rings.push_back(ring_of({{58, 8}, {92, 14}, {90, 26}, {60, 22}}));
    rings.push_back(ring_of({{56, 84}, {75, 78}, {94, 86}, {80, 104}, {64, 100}}));
    return {s, rings};
}

// A whole search with tiles of some side; nothing drawn by hand.
struct Searched {
    Raster<float> field;
    Raster<std::uint8_t> closed;
    SkeletonCells skeleton;
    CandidateResult result;
};
Searched searched(std::int64_t tile_cells, int threads) {
    const World w = blocks(tile_cells);
    const Job job(w.options({}), w.site_file(), threads);
    const FieldTiles field = job.field();
    Searched out;
    FieldWindow whole = field.window(w.whole_grid());
    out.field = std::move(whole.vf_rad);
    out.closed = std::move(whole.closed);
    const SkeletonTiles skeleton = make_skeleton(job.tables, field, job.options.threshold_rad);
    out.skeleton = skeleton.all();
    out.result = job.candidates(field, make_ridges(job.tables, skeleton));
    return out;
}

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

TEST(Tiles, OfAnySideGiveTheSameFieldSkeletonAndTable) {
    const Searched one = searched(256, 1);
    EXPECT_GT(one.skeleton.cell.size(), 300U);
    EXPECT_GT(one.result.candidates.size(), 60U);
    for (const auto& [side, threads] : {std::pair(64, 1), std::pair(100, 2), std::pair(64, 2)}) {
        const Searched other = searched(side, threads);
        ASSERT_EQ(one.field.size(), other.field.size());
        for (std::size_t i = 0; i < one.field.size(); ++i) {
            ASSERT_TRUE(same(one.field[i], other.field[i])) << "cell " << i;
        }
        EXPECT_EQ(one.closed, other.closed);
        EXPECT_EQ(one.skeleton.cell, other.skeleton.cell);
        EXPECT_EQ(one.skeleton.squared, other.skeleton.squared);
        test::expect_same(one.result, other.result);
    }
}

TEST(Tiles, TheSkeletonOfTilesIsThatOfTheWholeGrid) {
    const Searched tiles = searched(64, 2);
    const World w = blocks(64);
    const auto whole = w.ridges();  // thinned at once, spurs pruned
    SkeletonCells pruned = tiles.skeleton;
    prune_spurs(w.grid, pruned);
    EXPECT_EQ(pruned.cell, whole.cells.cell);
    EXPECT_EQ(pruned.squared, whole.cells.squared);
    EXPECT_LT(pruned.cell.size(), tiles.skeleton.cell.size());
}

TEST(Tiles, ClosedLinksAreThoseOfTheWholeGrid) {
    World::Setting s;
    s.tile_cells = 64;
    s.scanner.range_max_m = 4;
    const std::vector<Wall> thin = {test::wall({3, 3.2}, {95, 60.7}),
                                    test::wall({31.5, 25}, {32, 62}),
                                    test::wall({10.3, 64}, {96.2, 64})};
    const World w(s, {box_ring(0, 0, 100, 70)}, thin);
    ASSERT_GT(w.layout.patches(), 4);
    ASSERT_GT(w.layout.tiles(), 2);
    const auto whole = closed_steps(w.grid, w.standable, w.walls, w.whole_grid());
    for (std::int64_t c = 0; c < w.grid.size(); ++c) {
        EXPECT_EQ(w.closed[static_cast<std::size_t>(c)], whole[static_cast<std::size_t>(c)])
            << w.grid.ix(c) << ", " << w.grid.iy(c);
    }
}

// --- shards --------------------------------------------------------------------------------------

struct Counted {
    World world = test::hall();
    Job job{world.options({}), world.site_file(), 2};
    ShardNames names = job.tables.passing("count");
    std::atomic<int> made = 0;

    void phase(std::int64_t n = 5) {
        make_shards(job.tables, names, n, [&](std::int64_t i, const std::filesystem::path& path) {
            ++made;
            h5::Writer file = begin_shard(path, job.key);
            file.write("n", std::vector<std::int64_t>{i});
            finish_shard(file);
        });
    }
    std::filesystem::path path(std::int64_t i) const { return names.one(i); }
};

TEST(Shards, AreMadeOnce) {
    Counted c;
    c.phase();
    EXPECT_EQ(c.made, 5);
    c.phase();
    EXPECT_EQ(c.made, 5);
    c.phase(7);
    EXPECT_EQ(c.made, 7);
    for (std::int64_t i = 0; i < 7; ++i) {
        EXPECT_EQ(h5::Reader(c.path(i)).read<std::int64_t>("n"), std::vector<std::int64_t>{i});
    }
}

TEST(Shards, WhatIsMissingDamagedOrOfAnotherJobIsMadeAgain) {
    Counted c;
    c.phase();
    const std::string good = read_text(c.path(1));
    std::filesystem::remove(c.path(0));
    std::string damaged = good;
    damaged[100] = static_cast<char>(damaged[100] ^ 1);
    test::overwrite(c.path(1), damaged);
    test::overwrite(c.path(2), good.substr(0, 50));
    {
        h5::Writer other = begin_shard(c.path(3), "another job");
        finish_shard(other);
    }
    {
        h5::Writer unfinished = begin_shard(c.path(4), c.job.key);
        unfinished.close();
    }
    for (const std::int64_t i : {3, 4}) test::overwrite(c.path(i), read_text(c.path(i)));
    c.made = 0;
    c.phase();
    EXPECT_EQ(c.made, 5);
    EXPECT_EQ(read_text(c.path(1)), good);
    for (std::int64_t i = 0; i < 5; ++i) {
        EXPECT_EQ(h5::Reader(c.path(i)).read<std::int64_t>("n"), std::vector<std::int64_t>{i});
    }
}

TEST(Shards, WhatFailsNamesTheShardAndHowToRepeatIt) {
    Counted c;
    const auto failing = [&](auto&& fail) {
        try {
            make_shards(c.job.tables, c.names, 3,
                        [&](std::int64_t i, const std::filesystem::path&) {
                            if (i == 1) fail();
                        });
        } catch (const std::exception& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    const std::string said = failing([] { throw std::out_of_range("vector"); });
    for (const std::string& words : {std::string("count-00001.h5 could not be made: vector"),
                                     "vfplan run '" + (c.job.dir / "job.toml").string() +
                                         "' --out '" + c.job.dir.string() + "'"}) {
        EXPECT_NE(said.find(words), std::string::npos) << said;
    }
    // What the user can mend says so itself.
    EXPECT_EQ(failing([] { throw IoError("no space"); }), "no space");
}

// --- where stations may stand --------------------------------------------------------------------

TEST(Standable, BandsOfPatchesGiveTheCellsOfTheWholeGrid) {
    for (const double clearance : {0.0, 0.7}) {
        GroundOptions options;
        options.cell_m = 0.5;
        options.range_max_m = 1;  // small patches
        options.clearance_m = clearance;
        Site site;
        const std::vector<Ring> rings = {ring_of({{5, 5}, {17, 7}, {12, 19}}),
                                         ring_of({{20, 3}, {33, 15.9}, {20, 16.1}}),
                                         box_ring(2, 25, 38, 27), box_ring(0, 0, 41, 33)};
        site.free_border = border_of(rings);
        for (const Ring& r : rings) test::add_ring(site.walls, r);
        site.extent = test::bounds_of(site.walls);
        const Layout layout = layout_of(options, site);
        ASSERT_GT(layout.patches(), 4);
        const auto bits = standable_bits(options, site, layout, Threads(2));
        const Raster<std::uint8_t> free = free_cells(layout.grid, site.free_border);
        const Raster<std::uint8_t> near = cells_near_walls(layout.grid, site.walls, clearance);
        std::int64_t standing = 0;
        for (std::int64_t p = 0; p < layout.patches(); ++p) {
            const Window w = layout.patch_window(p);
            std::size_t i = 0;
            for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
                for (std::int32_t x = w.x_begin; x < w.x_end; ++x, ++i) {
                    const auto c = static_cast<std::size_t>(layout.grid.id(x, y));
                    const int want = free[c] != 0 && near[c] == 0 ? 1 : 0;
                    const int got = bits[static_cast<std::size_t>(p)][i / 8] >> (i % 8) & 1;
                    ASSERT_EQ(got, want) << x << ", " << y;
                    standing += got;
                }
            }
        }
        EXPECT_GT(standing, 500);
    }
}

}  // namespace
}  // namespace vfplan
