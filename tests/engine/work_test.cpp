// Phases of shards: resumable, mended, and the same for tiles of any side.
#include "engine/work.h"

#include <gtest/gtest.h>

#include <atomic>
#include <tuple>

#include "engine/site_stage.h"
#include "io/files.h"
#include "tests/engine/ground.h"

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
    const Job job(w.config({}), w.site_file(), threads);
    make_field_tiles(job.work);
    Searched out;
    FieldWindow whole = read_field_window(job.dir, w.layout, w.whole_grid());
    out.field = std::move(whole.vf_rad);
    out.closed = std::move(whole.closed);
    make_skeleton_tiles(job.work);
    std::vector<std::pair<std::int64_t, std::int32_t>> cells;
    for (std::int64_t t = 0; t < w.layout.tiles(); ++t) {
        const h5::Reader file(job.work.passing("skeleton", t));
        const auto cell = file.read<std::int64_t>("cell");
        const auto squared = file.read<std::int32_t>("squared");
        for (std::size_t i = 0; i < cell.size(); ++i) cells.emplace_back(cell[i], squared[i]);
    }
    std::sort(cells.begin(), cells.end());
    for (const auto& [cell, squared] : cells) {
        out.skeleton.cell.push_back(cell);
        out.skeleton.squared.push_back(squared);
    }
    make_ridge_graph(job.work, true);
    out.result = job.candidates();
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
        const CandidateResult& a = one.result;
        const CandidateResult& b = other.result;
        ASSERT_EQ(a.candidates.size(), b.candidates.size());
        for (std::size_t i = 0; i < a.candidates.size(); ++i) {
            const Candidate& p = a.candidates[i];
            const Candidate& q = b.candidates[i];
            ASSERT_EQ(std::tuple(p.at.x(), p.at.y(), p.cell, p.kind, p.vf_rad),
                      std::tuple(q.at.x(), q.at.y(), q.cell, q.kind, q.vf_rad));
        }
        EXPECT_EQ(a.table.begin, b.table.begin);
        ASSERT_EQ(a.table.seen.size(), b.table.seen.size());
        for (std::size_t i = 0; i < a.table.seen.size(); ++i) {
            const Seen& p = a.table.seen[i];
            const Seen& q = b.table.seen[i];
            ASSERT_EQ(std::tuple(p.piece, p.fraction, p.angle_rad),
                      std::tuple(q.piece, q.fraction, q.angle_rad));
        }
        EXPECT_EQ(a.reach, b.reach);
        EXPECT_EQ(a.report.parts, b.report.parts);
        EXPECT_EQ(a.report.parts_before_links, b.report.parts_before_links);
        EXPECT_EQ(a.report.rescued_pieces, b.report.rescued_pieces);
        EXPECT_EQ(a.report.ridges_short_of_overlap, b.report.ridges_short_of_overlap);
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
    const auto whole = closed_links(w.grid, w.standable, w.walls, w.whole_grid());
    for (std::int64_t c = 0; c < w.grid.size(); ++c) {
        EXPECT_EQ(w.closed[static_cast<std::size_t>(c)], whole[static_cast<std::size_t>(c)])
            << w.grid.ix(c) << ", " << w.grid.iy(c);
    }
}

// --- shards --------------------------------------------------------------------------------------

struct Counted {
    World world = test::hall();
    Job job{world.config({}), world.site_file(), 2};
    std::atomic<int> made = 0;

    void phase(std::int64_t n = 5) {
        make_shards(
            job.work, "test", n, [&](std::int64_t i) { return job.work.passing("count", i); },
            [&](std::int64_t i, const std::filesystem::path& path) {
                ++made;
                h5::Writer file = shard_writer(path, job.work.key);
                file.write("n", std::vector<std::int64_t>{i});
                finish_shard(file);
            });
    }
    std::filesystem::path path(std::int64_t i) const { return job.work.passing("count", i); }
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
        h5::Writer other = shard_writer(c.path(3), "another job");
        finish_shard(other);
    }
    {
        h5::Writer unfinished = shard_writer(c.path(4), c.job.work.key);
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

// --- where stations may stand --------------------------------------------------------------------

TEST(Standable, BandsOfPatchesGiveTheCellsOfTheWholeGrid) {
    for (const double clearance : {0.0, 0.7}) {
        Config config;
        config.field.cell_m = 0.5;
        config.scanner.range_max_m = 1;  // small patches
        config.site.clearance_m = clearance;
        Site site;
        const std::vector<Ring> holes = {ring_of({{5, 5}, {17, 7}, {12, 19}}),
                                         ring_of({{20, 3}, {33, 15.9}, {20, 16.1}}),
                                         box_ring(2, 25, 38, 27)};
        site.free_region = holes;
        site.free_region.push_back(box_ring(0, 0, 41, 33));
        for (const Ring& r : site.free_region) test::add_ring(site.walls, r);
        site.extent = test::bounds_of(site.walls);
        const Layout layout = layout_of(config, site);
        ASSERT_GT(layout.patches(), 4);
        const auto bits = standable_bits(config, site, layout, Threads(2));
        const Raster<std::uint8_t> free = free_cells(layout.grid, site.free_region);
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
