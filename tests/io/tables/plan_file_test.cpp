#include "io/tables/plan_file.h"

#include <gtest/gtest.h>

#include <tuple>

#include "io/files.h"
#include "io/tables/certificate_text.h"
#include "tests/io/site/features.h"

namespace vfplan {
namespace {

PlanTable sample_plan() {
    PlanTable t;
    t.plan.stations = {{4, 0, 0, 12.5, 12.5, 3.5, true, false, 0.375},
                       {2, 0, 1, 3, 9.25, 0.5, false, true, 0.375},
                       {9, 1, 2, 1, 1, 1, false, false, 0}};
    t.plan.links = {{0, 1, 0.375, {0.5, 0.375, 0.25, 0.125, 0.0625}}};
    t.plan.pieces = {PieceStatus::covered, PieceStatus::unreached, PieceStatus::no_viewpoint};
    const NetworkProof proof{2, {{3, 4}}, 1, -1, {{LineKind::arcs, 0, {2, 5}}}, {{-1, {{0, 7}}}}};
    t.plan.certificate.networks = {proof, {1, {}, -1, 5, {}, {{-1, {}}}}};
    t.key = "of coverage";
    t.overlap = {OverlapRatio::union_ang, 0.3};
    t.survives = true;
    return t;
}

TEST(PlanFile, ComesBack) {
    const test::TemporaryFile file("plan.h5");
    const PlanTable t = sample_plan();
    write_plan(file.path(), t);
    const PlanTable got = read_plan(file.path());
    ASSERT_EQ(got.plan.stations.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        const auto all = [i](const Plan& p) {
            const Station& s = p.stations[i];
            return std::tuple(s.candidate, s.network, s.order, s.new_length_m, s.seen_length_m,
                              s.only_length_m, s.articulation, s.bridge_end, s.needed_overlap);
        };
        EXPECT_EQ(all(got.plan), all(t.plan));
    }
    ASSERT_EQ(got.plan.links.size(), 1U);
    EXPECT_EQ(std::pair(got.plan.links[0].from, got.plan.links[0].to), std::pair(0, 1));
    EXPECT_EQ(got.plan.links[0].overlap, 0.375);
    EXPECT_EQ(got.plan.links[0].ratios, t.plan.links[0].ratios);
    EXPECT_EQ(got.plan.pieces, t.plan.pieces);
    EXPECT_EQ(text_of(got.plan.certificate), text_of(t.plan.certificate));
    EXPECT_EQ(got.plan.certificate.bound(), 3);
    EXPECT_EQ(got.key, t.key);
    EXPECT_TRUE(got.survives);
    EXPECT_EQ(got.overlap.ratio, OverlapRatio::union_ang);
    EXPECT_EQ(got.overlap.threshold, 0.3);
}

TEST(PlanFile, EqualPlansGiveEqualBytes) {
    const test::TemporaryFile file("plan.h5");
    write_plan(file.path(), sample_plan());
    const std::string plan = read_text(file.path());
    write_plan(file.path(), sample_plan());
    EXPECT_EQ(plan, read_text(file.path()));
}

}  // namespace
}  // namespace vfplan
