#include "io/tables.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "io/files.h"
#include "io/h5.h"
#include "kernels/error.h"
#include "tests/io/features.h"

namespace vfplan {
namespace {

FieldTable sample_field() {
    FieldTable t;
    t.grid.origin = {-3.25, 7.5};
    t.grid.cell_m = 0.1;
    t.grid.nx = 40;
    t.grid.ny = 30;
    for (int i = 0; i < 1200; ++i) {
        t.vf_rad.push_back(i % 7 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                      : 0.005F * static_cast<float>(i));
    }
    t.origin = {500000, 4480000};
    t.crs_wkt = "PROJCS[\"somewhere\"]";
    t.key = "abc123";
    return t;
}

CoverageTables sample_coverage() {
    CoverageTables t;
    Wall w;
    w.a = {0.1, 0.2};
    w.b = {7.3, -4.4};
    w.cls = WallClass::window;
    w.scanned = false;
    w.free_side[left] = false;
    t.walls.push_back(w);
    t.walls.push_back({{0, 0}, {10, 0}, WallClass::wall, true, {true, true}});
    t.pieces = cut_into_pieces(t.walls, 3);
    t.reach.assign(static_cast<std::size_t>(t.pieces.size()), PieceStatus::covered);
    t.reach[1] = PieceStatus::no_viewpoint;
    t.reach[2] = PieceStatus::off_candidates;
    t.candidates = {{{1.5, 2.5}, 77, CandidateKind::rescue, 3.25F},
                    {{-1e-3, 1e6}, -1, CandidateKind::existing, 0}};
    t.table.add({{0, 0.5F, 0.125F}, {3, 1, 0.75F}});
    t.table.add({});
    t.origin = {1, 2};
    t.key = "key";
    return t;
}

PlanTable sample_plan() {
    PlanTable t;
    t.plan.stations = {{4, 0, 0, 12.5, 12.5}, {2, 0, 1, 3, 9.25}, {9, 1, 2, 1, 1}};
    t.plan.links = {{0, 1, 0.375, {0.5, 0.375, 0.25, 0.125, 0.0625}}};
    t.plan.pieces = {PieceStatus::covered, PieceStatus::unreached, PieceStatus::no_viewpoint};
    t.plan.bound_pieces = {0, 2};
    t.key = "of coverage";
    t.overlap_ratio = "mean_len";
    t.threshold = 0.3;
    return t;
}

TEST(Tables, FieldComesBack) {
    const test::TemporaryFile file("field.h5");
    const FieldTable t = sample_field();
    write_field(file.path(), t);
    const FieldTable got = read_field(file.path());
    EXPECT_EQ(got.grid.origin, t.grid.origin);
    EXPECT_EQ(got.grid.cell_m, t.grid.cell_m);
    EXPECT_EQ(got.grid.nx, 40);
    EXPECT_EQ(got.grid.ny, 30);
    EXPECT_EQ(got.origin, t.origin);
    EXPECT_EQ(got.crs_wkt, t.crs_wkt);
    EXPECT_EQ(got.key, t.key);
    ASSERT_EQ(got.vf_rad.size(), t.vf_rad.size());
    for (std::size_t i = 0; i < t.vf_rad.size(); ++i) {
        EXPECT_EQ(std::isnan(got.vf_rad[i]), std::isnan(t.vf_rad[i]));
        if (!std::isnan(t.vf_rad[i])) {
            EXPECT_EQ(got.vf_rad[i], t.vf_rad[i]);
        }
    }
}

TEST(Tables, FieldNamesTheCentresOfItsCells) {
    const test::TemporaryFile file("field.h5");
    const FieldTable t = sample_field();
    write_field(file.path(), t);
    const h5::Reader in(file.path());
    EXPECT_EQ(in.dims("vf"), (h5::Dims{30, 40}));
    const std::vector<double> x = in.read<double>("x");
    const std::vector<double> y = in.read<double>("y");
    ASSERT_EQ(x.size(), 40U);
    ASSERT_EQ(y.size(), 30U);
    EXPECT_NEAR(x[0], 500000 - 3.25 + 0.05, 1e-9);
    EXPECT_NEAR(y[29], 4480000 + 7.5 + 2.95, 1e-9);
}

TEST(Tables, CoverageComesBack) {
    const test::TemporaryFile file("coverage.h5");
    const CoverageTables t = sample_coverage();
    write_coverage(file.path(), t);
    const CoverageTables got = read_coverage(file.path());
    ASSERT_EQ(got.walls.size(), t.walls.size());
    for (std::size_t i = 0; i < t.walls.size(); ++i) {
        EXPECT_EQ(got.walls[i].a, t.walls[i].a);
        EXPECT_EQ(got.walls[i].b, t.walls[i].b);
        EXPECT_EQ(got.walls[i].cls, t.walls[i].cls);
        EXPECT_EQ(got.walls[i].scanned, t.walls[i].scanned);
        EXPECT_EQ(got.walls[i].free_side[left], t.walls[i].free_side[left]);
        EXPECT_EQ(got.walls[i].free_side[right], t.walls[i].free_side[right]);
    }
    EXPECT_EQ(got.pieces.wall, t.pieces.wall);
    EXPECT_EQ(got.pieces.side, t.pieces.side);
    EXPECT_EQ(got.pieces.s0_m, t.pieces.s0_m);
    EXPECT_EQ(got.pieces.s1_m, t.pieces.s1_m);
    EXPECT_EQ(got.pieces.first_of, t.pieces.first_of);
    EXPECT_EQ(got.pieces.count_of, t.pieces.count_of);
    EXPECT_EQ(got.reach, t.reach);
    ASSERT_EQ(got.candidates.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(got.candidates[i].at, t.candidates[i].at);
        EXPECT_EQ(got.candidates[i].cell, t.candidates[i].cell);
        EXPECT_EQ(got.candidates[i].kind, t.candidates[i].kind);
        EXPECT_EQ(got.candidates[i].vf_rad, t.candidates[i].vf_rad);
    }
    EXPECT_EQ(got.table.begin, t.table.begin);
    ASSERT_EQ(got.table.seen.size(), t.table.seen.size());
    for (std::size_t i = 0; i < t.table.seen.size(); ++i) {
        EXPECT_EQ(got.table.seen[i].piece, t.table.seen[i].piece);
        EXPECT_EQ(got.table.seen[i].fraction, t.table.seen[i].fraction);
        EXPECT_EQ(got.table.seen[i].angle_rad, t.table.seen[i].angle_rad);
    }
    EXPECT_EQ(got.origin, t.origin);
    EXPECT_EQ(got.crs_wkt, "");
    EXPECT_EQ(got.key, "key");
}

TEST(Tables, CoverageIsASparseMatrixForOthersToRead) {
    const test::TemporaryFile file("coverage.h5");
    write_coverage(file.path(), sample_coverage());
    const h5::Reader in(file.path());
    EXPECT_EQ(in.text("coverage", "encoding-type"), "csr_matrix");
    EXPECT_EQ(in.text("coverage", "encoding-version"), "0.1.0");
    EXPECT_TRUE(in.has_attribute("coverage", "shape"));
    EXPECT_EQ(in.read<std::int64_t>("coverage/indptr"), (std::vector<std::int64_t>{0, 2, 2}));
    EXPECT_EQ(in.read<std::int32_t>("coverage/indices"), (std::vector<std::int32_t>{0, 3}));
}

TEST(Tables, PlanComesBack) {
    const test::TemporaryFile file("plan.h5");
    const PlanTable t = sample_plan();
    write_plan(file.path(), t);
    const PlanTable got = read_plan(file.path());
    ASSERT_EQ(got.plan.stations.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(got.plan.stations[i].candidate, t.plan.stations[i].candidate);
        EXPECT_EQ(got.plan.stations[i].network, t.plan.stations[i].network);
        EXPECT_EQ(got.plan.stations[i].order, t.plan.stations[i].order);
        EXPECT_EQ(got.plan.stations[i].new_length_m, t.plan.stations[i].new_length_m);
        EXPECT_EQ(got.plan.stations[i].seen_length_m, t.plan.stations[i].seen_length_m);
    }
    ASSERT_EQ(got.plan.links.size(), 1U);
    EXPECT_EQ(got.plan.links[0].from, 0);
    EXPECT_EQ(got.plan.links[0].to, 1);
    EXPECT_EQ(got.plan.links[0].overlap, 0.375);
    EXPECT_EQ(got.plan.links[0].ratios, t.plan.links[0].ratios);
    EXPECT_EQ(got.plan.pieces, t.plan.pieces);
    EXPECT_EQ(got.plan.bound_pieces, t.plan.bound_pieces);
    EXPECT_EQ(got.key, t.key);
    EXPECT_EQ(got.overlap_ratio, "mean_len");
    EXPECT_EQ(got.threshold, 0.3);
}

TEST(Tables, EmptyTablesComeBack) {
    const test::TemporaryFile coverage("coverage.h5");
    write_coverage(coverage.path(), {});
    EXPECT_EQ(read_coverage(coverage.path()).table.rows(), 0);
    const test::TemporaryFile plan("plan.h5");
    write_plan(plan.path(), {});
    EXPECT_TRUE(read_plan(plan.path()).plan.stations.empty());
}

TEST(Tables, EqualTablesGiveEqualBytes) {
    const test::TemporaryFile file("bytes.h5");
    const auto bytes = [&](auto&& write) {
        write();
        return read_text(file.path());
    };
    const auto field = [&] { write_field(file.path(), sample_field()); };
    const auto coverage = [&] { write_coverage(file.path(), sample_coverage()); };
    const auto plan = [&] { write_plan(file.path(), sample_plan()); };
    EXPECT_EQ(bytes(field), bytes(field));
    EXPECT_EQ(bytes(coverage), bytes(coverage));
    EXPECT_EQ(bytes(plan), bytes(plan));
    EXPECT_NE(bytes(coverage), bytes(plan));
}

TEST(Tables, KeyOfWhatIsComplete) {
    const test::TemporaryFile file("key.h5");
    EXPECT_EQ(key_of(file.path()), "");
    write_text(file.path(), "damaged");
    EXPECT_EQ(key_of(file.path()), "");
    {
        h5::Writer out(file.path());  // a key, but never finished
        out.attribute("/", "key", "early");
        out.close();
    }
    EXPECT_EQ(key_of(file.path()), "");
    write_field(file.path(), sample_field());
    EXPECT_EQ(key_of(file.path()), "abc123");
    EXPECT_THROW(read_plan(file.path()), IoError);  // a field is no plan
}

}  // namespace
}  // namespace vfplan
