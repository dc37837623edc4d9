#include "io/tables/coverage_file.h"
#include "io/tables/field_file.h"
#include "io/tables/field_tiles.h"
#include "io/tables/plan_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "io/files.h"
#include "io/h5_reader.h"
#include "io/h5_writer.h"
#include "kernels/error.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

// A run directory with a field of 40 x 30 cells in tiles of 16.
struct FieldFolder {
    test::TemporaryFolder folder{"field"};
    FieldInfo info;
    Raster<float> vf_rad;
    std::vector<std::filesystem::path> tiles;
    ShardNames names{folder.path() / "shards", "field", "-16"};

    FieldFolder() {
        Grid grid;
        grid.origin = {-3.25, 7.5};
        grid.cell_m = 0.1;
        grid.nx = 40;
        grid.ny = 30;
        info.layout = {grid, 32, 16};
        info.origin = {500000, 4480000};
        info.crs_wkt = "PROJCS[\"somewhere\"]";
        info.key = "abc123";
        info.summary = R"({"cells":1200})";
        for (int i = 0; i < 1200; ++i) {
            vf_rad.push_back(i % 7 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                        : 0.005F * static_cast<float>(i));
        }
        std::filesystem::create_directories(folder.path() / "shards");
        for (std::int64_t t = 0; t < info.layout.tiles(); ++t) write_tile(t, "abc123");
        write_field_index(index(), info, tiles);
    }
    std::filesystem::path index() const { return folder.path() / "field.h5"; }
    void write_tile(std::int64_t t, const std::string& key) {
        const Window w = info.layout.tile_window(t);
        Raster<float> part;
        for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
            for (std::int32_t x = w.x_begin; x < w.x_end; ++x) {
                part.push_back(vf_rad[static_cast<std::size_t>(info.layout.grid.id(x, y))]);
            }
        }
        const std::filesystem::path path = names.one(t);
        write_field_tile(path, key, {w, part, Raster<std::uint8_t>(part.size(), 3), {}});
        if (tiles.size() == static_cast<std::size_t>(t)) tiles.push_back(path);
    }
};

bool same(float a, float b) { return (std::isnan(a) && std::isnan(b)) || a == b; }

// A coverage table in two blocks with rows and one without.
struct CoverageFolder {
    test::TemporaryFolder folder{"coverage"};
    std::vector<Wall> walls;
    Pieces pieces;
    std::vector<Candidate> candidates = {{{1.5, 2.5}, 77, CandidateKind::rescue, 3.25F},
                                         {{-1e-3, 1e6}, -1, CandidateKind::existing, 0},
                                         {{4, 5}, 12, CandidateKind::joint, 1.5F}};
    std::vector<CoverageRow> rows = {{{0, 0.5F, 0.125F}, {3, 1, 0.75F}}, {}, {{3, 1, 0.5F}}};
    std::vector<std::filesystem::path> blocks;
    CoverageInfo info{{1, 2}, "", "key", "{}", {}};

    CoverageFolder() {
        Wall w;
        w.a = {0.1, 0.2};
        w.b = {7.3, -4.4};
        w.cls = WallClass::window;
        w.scanned = false;
        w.free_side[left] = false;
        walls.push_back(w);
        walls.push_back({{0, 0}, {10, 0}, WallClass::wall, true, {true, true}});
        pieces = cut_into_pieces(walls, 3);
        std::filesystem::create_directories(folder.path() / "shards");
        write_block_of(0, 0, 2);
        write_block_of(1, 2, 2);
        write_block_of(2, 2, 3);
        write_coverage_index(index(), walls, pieces, blocks, info);
    }
    std::filesystem::path index() const { return folder.path() / "coverage.h5"; }
    void write_block_of(int number, std::size_t from, std::size_t to) {
        CoverageBlock block;
        for (std::size_t i = from; i < to; ++i) {
            block.candidates.push_back(candidates[i]);
            block.table.add(rows[i]);
        }
        blocks.push_back(folder.path() / "shards" / fmt::format("coverage-{:05}.h5", number));
        write_coverage_block(blocks.back(), "key", block);
    }
};

TEST(Tables, FieldComesBack) {
    const FieldFolder f;
    const FieldFile got(f.index());
    EXPECT_EQ(got.grid().origin, f.info.layout.grid.origin);
    EXPECT_EQ(got.grid().cell_m, f.info.layout.grid.cell_m);
    EXPECT_EQ(got.grid().nx, 40);
    EXPECT_EQ(got.grid().ny, 30);
    EXPECT_EQ(got.info().layout.patch_cells, 32);
    EXPECT_EQ(got.info().layout.tile_cells, 16);
    EXPECT_EQ(got.info().origin, f.info.origin);
    EXPECT_EQ(got.info().crs_wkt, f.info.crs_wkt);
    EXPECT_EQ(got.info().key, f.info.key);
    EXPECT_EQ(got.info().summary, f.info.summary);
    const Raster<float> whole = got.read({0, 0, 40, 30});
    ASSERT_EQ(whole.size(), f.vf_rad.size());
    for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_TRUE(same(whole[i], f.vf_rad[i])) << i;
}

TEST(Tables, AWindowOfTheFieldGoesOverItsTiles) {
    const FieldFolder f;
    const FieldFile got(f.index());
    for (const Window& w : {Window{0, 0, 1, 1}, Window{10, 5, 35, 29}, Window{16, 16, 32, 30},
                            Window{39, 29, 40, 30}}) {
        const Raster<float> part = got.read(w);
        std::size_t i = 0;
        for (std::int32_t y = w.y_begin; y < w.y_end; ++y) {
            for (std::int32_t x = w.x_begin; x < w.x_end; ++x, ++i) {
                EXPECT_TRUE(same(part[i], f.vf_rad[static_cast<std::size_t>(got.grid().id(x, y))]));
            }
        }
        EXPECT_EQ(part.size(), i);
    }
    Raster<float> bands;
    got.each_band([&](const Window& w, const Raster<float>& vf) {
        EXPECT_EQ(w.x_begin, 0);
        EXPECT_EQ(w.x_end, 40);
        EXPECT_EQ(static_cast<std::size_t>(w.y_begin) * 40, bands.size());
        bands.insert(bands.end(), vf.begin(), vf.end());
    });
    ASSERT_EQ(bands.size(), f.vf_rad.size());
    for (std::size_t i = 0; i < bands.size(); ++i) EXPECT_TRUE(same(bands[i], f.vf_rad[i]));
}

TEST(Tables, AReducedFieldHasMeansOverSquares) {
    const FieldFolder f;
    const FieldFile got(f.index());
    const FieldFile::Reduced all = got.reduced(1200);
    ASSERT_EQ(all.vf_rad.size(), f.vf_rad.size());
    for (std::size_t i = 0; i < all.vf_rad.size(); ++i) {
        EXPECT_TRUE(same(all.vf_rad[i], f.vf_rad[i]));
    }
    const FieldFile::Reduced half = got.reduced(1199);
    EXPECT_EQ(half.grid.nx, 20);
    EXPECT_EQ(half.grid.ny, 15);
    EXPECT_EQ(half.grid.cell_m, 0.2);
    EXPECT_EQ(half.grid.origin, got.grid().origin);
    for (std::int32_t y = 0; y < 15; ++y) {
        for (std::int32_t x = 0; x < 20; ++x) {
            float sum = 0;
            int count = 0;
            for (const std::int32_t k : {0, 1, 2, 3}) {
                const std::int64_t c = got.grid().id(2 * x + k % 2, 2 * y + k / 2);
                const float v = f.vf_rad[static_cast<std::size_t>(c)];
                if (std::isnan(v)) continue;
                sum += v;
                ++count;
            }
            const float v = half.vf_rad[static_cast<std::size_t>(half.grid.id(x, y))];
            if (count < 2) {
                EXPECT_TRUE(std::isnan(v));
            } else {
                EXPECT_FLOAT_EQ(v, sum / static_cast<float>(count));
            }
        }
    }
}

TEST(Tables, FieldNamesTheCentresOfItsCells) {
    const FieldFolder f;
    const h5::Reader in(f.index());
    EXPECT_EQ(in.dims("vf"), (h5::Dims{30, 40}));
    const std::vector<double> x = in.read<double>("x");
    const std::vector<double> y = in.read<double>("y");
    ASSERT_EQ(x.size(), 40U);
    ASSERT_EQ(y.size(), 30U);
    EXPECT_NEAR(x[0], 500000 - 3.25 + 0.05, 1e-9);
    EXPECT_NEAR(y[29], 4480000 + 7.5 + 2.95, 1e-9);
}

TEST(Tables, CoverageComesBack) {
    const CoverageFolder f;
    const CoverageTables got = read_coverage(f.index());
    ASSERT_EQ(got.walls.size(), f.walls.size());
    for (std::size_t i = 0; i < f.walls.size(); ++i) {
        EXPECT_EQ(got.walls[i].a, f.walls[i].a);
        EXPECT_EQ(got.walls[i].b, f.walls[i].b);
        EXPECT_EQ(got.walls[i].cls, f.walls[i].cls);
        EXPECT_EQ(got.walls[i].scanned, f.walls[i].scanned);
        EXPECT_EQ(got.walls[i].free_side[left], f.walls[i].free_side[left]);
        EXPECT_EQ(got.walls[i].free_side[right], f.walls[i].free_side[right]);
    }
    ASSERT_EQ(got.pieces.size(), f.pieces.size());
    for (std::int64_t p = 0; p < f.pieces.size(); ++p) {
        EXPECT_EQ(got.pieces.place(p).wall, f.pieces.place(p).wall);
        EXPECT_EQ(got.pieces.place(p).side, f.pieces.place(p).side);
        EXPECT_EQ(got.pieces.place(p).s0_m, f.pieces.place(p).s0_m);
        EXPECT_EQ(got.pieces.place(p).s1_m, f.pieces.place(p).s1_m);
    }
    std::vector<PieceStatus> status(static_cast<std::size_t>(f.pieces.size()),
                                    PieceStatus::no_viewpoint);
    status[0] = status[3] = PieceStatus::covered;  // by some row
    EXPECT_EQ(got.status, status);
    ASSERT_EQ(got.candidates.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(got.candidates[i].at, f.candidates[i].at);
        EXPECT_EQ(got.candidates[i].cell, f.candidates[i].cell);
        EXPECT_EQ(got.candidates[i].kind, f.candidates[i].kind);
        EXPECT_EQ(got.candidates[i].vf_rad, f.candidates[i].vf_rad);
    }
    EXPECT_EQ(got.begin, (std::vector<std::int64_t>{0, 2, 2, 3}));
    EXPECT_EQ(got.rows(), 3);
    EXPECT_EQ(got.entries(), 3);
    EXPECT_EQ(got.origin, Vec2d(1, 2));
    EXPECT_EQ(got.crs_wkt, "");
    EXPECT_EQ(got.key, "key");
    EXPECT_EQ(got.summary, "{}");
}

TEST(Tables, EntriesAreReadAsFarAsTheyAreAskedFor) {
    const CoverageFolder f;
    const CoverageEntries entries(f.index());
    EXPECT_EQ(entries.pieces(0, 3), (std::vector<std::int32_t>{0, 3, 3}));
    EXPECT_EQ(entries.pieces(1, 2), (std::vector<std::int32_t>{3, 3}));
    EXPECT_EQ(entries.fractions(0, 2), (std::vector<float>{0.5F, 1}));
    EXPECT_EQ(entries.angles_rad(1, 2), (std::vector<float>{0.75F, 0.5F}));
    EXPECT_TRUE(entries.pieces(3, 0).empty());
}

TEST(Tables, CoverageIsASparseMatrixForOthersToRead) {
    const CoverageFolder f;
    const h5::Reader in(f.index());
    EXPECT_EQ(in.text("coverage", "encoding-type"), "csr_matrix");
    EXPECT_EQ(in.text("coverage", "encoding-version"), "0.1.0");
    EXPECT_TRUE(in.has_attribute("coverage", "shape"));
    EXPECT_EQ(in.read<std::int64_t>("coverage/indptr"), (std::vector<std::int64_t>{0, 2, 2, 3}));
    EXPECT_EQ(in.dims("coverage/indices"), (h5::Dims{3}));
    EXPECT_EQ(in.read<std::int32_t>("pieces/wall"),
              std::vector<std::int32_t>(static_cast<std::size_t>(f.pieces.size()), 1));
}

std::string message_of(const std::function<void()>& f) {
    try {
        f();
    } catch (const IoError& e) {
        return e.what();
    }
    return "no IoError";
}

TEST(Tables, AMissingDamagedOrOtherShardIsNamed) {
    FieldFolder f;
    const CoverageFolder c;
    const auto open_field = [&] { const FieldFile file(f.index()); };
    const auto open_coverage = [&] { read_coverage(c.index()); };
    EXPECT_EQ(message_of(open_field), "no IoError");
    EXPECT_EQ(message_of(open_coverage), "no IoError");
    for (const auto& [shard, open] :
         {std::pair<std::filesystem::path, std::function<void()>>(f.tiles[3], open_field),
          std::pair<std::filesystem::path, std::function<void()>>(c.blocks[1], open_coverage)}) {
        const std::string name = shard.filename().string();
        const std::string bytes = read_text(shard);
        std::filesystem::remove(shard);
        EXPECT_NE(message_of(open).find(name + ": missing"), std::string::npos);
        test::overwrite(shard, bytes.substr(0, bytes.size() / 2));
        EXPECT_NE(message_of(open).find(name), std::string::npos);
        std::string damaged = bytes;
        damaged[bytes.size() / 3] = static_cast<char>(damaged[bytes.size() / 3] ^ 4);
        test::overwrite(shard, damaged);
        EXPECT_NE(message_of(open).find(name), std::string::npos);
        test::overwrite(shard, bytes);
        EXPECT_EQ(message_of(open), "no IoError");
    }
    f.write_tile(3, "another job");  // whole, but not what was indexed
    test::overwrite(f.tiles[3], read_text(f.tiles[3]));
    EXPECT_NE(message_of(open_field).find("field-16-00003.h5: another shard"), std::string::npos);
}

TEST(Tables, AnIndexIsNotWrittenOverDamagedShards) {
    const FieldFolder f;
    const std::string bytes = read_text(f.tiles[2]);
    test::overwrite(f.tiles[2], bytes.substr(1));
    const std::filesystem::path other = f.folder.path() / "other.h5";
    EXPECT_NE(message_of([&] {
                  write_field_index(other, f.info, f.tiles);
              }).find(f.tiles[2].filename().string()),
              std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(other));
}

TEST(Tables, EmptyTablesComeBack) {
    const test::TemporaryFile coverage("coverage.h5");
    write_coverage_index(coverage.path(), {}, {}, {}, {});
    EXPECT_EQ(read_coverage(coverage.path()).rows(), 0);
    const test::TemporaryFile plan("plan.h5");
    write_plan(plan.path(), {});
    EXPECT_TRUE(read_plan(plan.path()).plan.stations.empty());
}

TEST(Tables, EqualTablesGiveEqualBytes) {
    std::string field;
    std::string coverage;
    for (int i = 0; i < 2; ++i) {
        const FieldFolder f;
        const CoverageFolder c;
        if (i == 0) {
            field = read_text(f.index()) + read_text(f.tiles[1]);
            coverage = read_text(c.index()) + read_text(c.blocks[0]);
        } else {
            EXPECT_EQ(field, read_text(f.index()) + read_text(f.tiles[1]));
            EXPECT_EQ(coverage, read_text(c.index()) + read_text(c.blocks[0]));
        }
    }
    EXPECT_NE(field, coverage);
}

TEST(Tables, ThoseOfAnotherVersionAreRefusedByName) {
    const test::TemporaryFile old("old.h5");
    for (const std::int64_t version : {0, 3, 5}) {
        h5::Writer file(old.path());
        if (version > 0) file.attribute("/", "format_version", version);
        file.close();
        for (const std::string& said : {message_of([&] { read_coverage(old.path()); }),
                                        message_of([&] { const FieldFile f(old.path()); }),
                                        message_of([&] { read_plan(old.path()); })}) {
            EXPECT_NE(said.find(fmt::format("version {}", version)), std::string::npos) << said;
            EXPECT_NE(said.find("old.h5"), std::string::npos) << said;
        }
    }
}

TEST(Tables, AFieldIsNoPlan) {
    const FieldFolder field;
    EXPECT_THROW(read_plan(field.index()), IoError);
}

}  // namespace
}  // namespace vfplan
