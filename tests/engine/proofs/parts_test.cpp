#include <gtest/gtest.h>

#include <random>

#include "engine/proofs/broken_lines.h"
#include "engine/proofs/flow.h"
#include "engine/proofs/lp.h"
#include "engine/proofs/multipliers.h"
#include "engine/proofs/weighing.h"
#include "engine/proofs/windows.h"
#include "tests/engine/proofs/checked.h"
#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

using test::every_plan;
using test::random_problem;

TEST(Flow, IsAsLargeAsTheLeastCut) {
    std::mt19937_64 random(1);
    for (int turn = 0; turn < 300; ++turn) {
        SCOPED_TRACE(turn);
        const auto nodes = static_cast<std::int32_t>(3 + random() % 6);
        Flow flow(nodes);
        std::vector<std::tuple<std::int32_t, std::int32_t, std::int64_t>> edges;
        for (std::int32_t a = 0; a < nodes; ++a) {
            for (std::int32_t b = 0; b < nodes; ++b) {
                if (a == b || random() % 2 == 0) continue;
                edges.emplace_back(a, b, static_cast<std::int64_t>(random() % 9));
                flow.add(a, b, std::get<2>(edges.back()));
            }
        }
        flow.keep();
        std::int64_t least = Flow::endless;
        const auto across = [&](auto&& inside) {
            std::int64_t sum = 0;
            for (const auto& [a, b, capacity] : edges)
                sum += inside(a) && !inside(b) ? capacity : 0;
            return sum;
        };
        for (std::uint32_t set = 1; set < 1U << static_cast<unsigned>(nodes); set += 2) {
            if ((set >> static_cast<unsigned>(nodes - 1) & 1U) != 0) continue;
            least = std::min(least, across([&](std::int32_t v) {
                                 return (set >> static_cast<unsigned>(v) & 1U) != 0;
                             }));
        }
        EXPECT_EQ(flow.run(0, nodes - 1, Flow::endless), least);
        const auto near_source = flow.source_side(0);
        const auto near_sink = flow.sink_side(nodes - 1);
        EXPECT_EQ(across([&](std::int32_t v) { return near_source[idx(v)] != 0; }), least);
        EXPECT_EQ(across([&](std::int32_t v) { return near_sink[idx(v)] == 0; }), least);
        flow.restore();
        EXPECT_GE(flow.run(0, nodes - 1, least), least);
    }
}

// Three rows that want two of three columns: halves.
TEST(Lp, GrowsAndShrinks) {
    Lp lp;
    for (int c = 0; c < 3; ++c) lp.add_column(1, 1);
    for (int r = 0; r < 3; ++r) {
        lp.add_row(std::vector<LpEntry>{{r, 1}, {(r + 1) % 3, 1}}, 1, false);
    }
    ASSERT_EQ(lp.solve(1000, 1e9), LpEnd::solved);
    EXPECT_NEAR(lp.value(), 1.5, 1e-9);
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(lp.weight_of_row(r), 0.5, 1e-9);
    lp.set_bounds(0, 0, 0);
    ASSERT_EQ(lp.solve(1000, 1e9), LpEnd::solved);
    EXPECT_NEAR(lp.value(), 2, 1e-9);
    EXPECT_EQ(lp.solve(1000, 1.75), LpEnd::cut_off);
    lp.set_bounds(0, 0, 1);
    lp.add_column(0.25, 1, std::vector<LpEntry>{{0, 1}, {1, 1}, {2, 1}});
    ASSERT_EQ(lp.solve(1000, 1e9, true), LpEnd::solved);
    EXPECT_NEAR(lp.value(), 0.25, 1e-9);
    lp.delete_rows({0, 2});
    lp.add_row(std::vector<LpEntry>{{0, 1}, {1, -1}}, 1, true);
    ASSERT_EQ(lp.solve(1000, 1e9), LpEnd::solved);
    EXPECT_NEAR(lp.value(), 1.25, 1e-9);
    EXPECT_EQ(lp.rows(), 2);
}

std::int64_t value_of(const Problem& p, const std::vector<std::int64_t>& weight) {
    const Root root = root_of(p);
    Lines lines(p, root);
    std::vector<ProofLine> all;
    std::vector<LineWeight> weights;
    for (std::int32_t r = 0; r < p.rows(); ++r) {
        all.push_back({LineKind::cover, r, {}});
        weights.push_back({r, weight[idx(r)]});
    }
    return Weighing(lines).value(all, weights, std::vector<Known>(idx(p.columns()), Known::free));
}

TEST(Multipliers, MoreRoundsAreNeverWorse) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p = random_problem(seed, 40, 120, seed % 2 == 0);
        std::int64_t before = -1;
        for (const std::int64_t rounds : {1, 10, 50, 200, 1000}) {
            const auto weight = weigh_rows(p, 30, rounds);
            ASSERT_GE(*std::min_element(weight.begin(), weight.end()), 0);
            const std::int64_t value = value_of(p, weight);
            EXPECT_GE(value + 1000, before);  // but for what rounding takes
            before = value;
        }
    }
}

// A long strip of columns: each overlaps with the next two and shares rows with some; larger than a
// window.
Problem strip(std::int32_t columns) {
    Problem p;
    std::mt19937_64 random(4);
    const auto count = static_cast<std::uint64_t>(columns);
    for (std::int32_t c = 0; c < columns; ++c) {
        for (const std::int32_t by : {-2, -1, 1, 2}) {
            if (c + by >= 0 && c + by < columns) p.near.to.push_back(c + by);
        }
        p.near.end_list();
        p.fixed.push_back(c == columns / 2 ? 1 : 0);
    }
    for (std::uint64_t r = 0; r < count / 2; ++r) {
        const auto first = static_cast<std::int32_t>(random() % count);
        for (std::int32_t c = first; c < std::min(columns, first + 7); ++c) {
            if (c == first || random() % 2 == 0) p.columns_of.to.push_back(c);
        }
        p.columns_of.end_list();
    }
    p.rows_of = transposed(p.columns_of, columns);
    return p;
}

TEST(Windows, AddToTheBoundAndTakeNothing) {
    const Problem p = strip(2600);
    const Root root = root_of(p);
    const auto weight = weigh_rows(p, 1300, 300);
    const std::int64_t before = value_of(p, weight);
    Effort effort{400'000'000};
    const Weighed better = weigh_by_windows(p, root, weight, effort);
    Lines lines(p, root);
    Weighing weighing(lines);
    const std::vector<Known> free(idx(p.columns()), Known::free);
    const std::int64_t after = weighing.value(better.lines, better.weights, free);
    // A strip of 2,600 that hangs together takes every second column; rows alone do not say so.
    EXPECT_GT(after, before + 50 * proof_scale);
    EXPECT_LE(stations_of(after), 1310);
    NetworkProof proof;
    proof.root_piece = root.row;
    proof.root_station = root.column;
    proof.bound = stations_of(after);
    proof.lines = better.lines;
    proof.cases = {{-1, better.weights}};
    EXPECT_EQ(test::wrong_with(p, proof), "");
    Effort none{0};
    const Weighed same = weigh_by_windows(p, root, weight, none);
    EXPECT_EQ(weighing.value(same.lines, same.weights, free), before);
}

// Every line is true of every plan, whatever set it names.
TEST(Lines, AreTrueOfEveryPlan) {
    std::mt19937_64 random(2);
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p =
            random_problem(seed, 3 + static_cast<std::int32_t>(seed % 6), 6, seed % 4 == 0);
        const Root root = root_of(p);
        Lines lines(p, root);
        std::vector<ProofLine> all = {{LineKind::root, -1, {}}};
        for (const std::int32_t c : root.columns) all.push_back({LineKind::first, c, {}});
        for (int turn = 0; turn < 30; ++turn) {
            std::vector<std::int32_t> set;
            for (std::int32_t c = 0; c < p.columns(); ++c) {
                if (random() % 2 == 0) set.push_back(c);
            }
            const auto row = static_cast<std::int32_t>(random() % idx(p.rows()));
            for (const LineKind kind : {LineKind::cover, LineKind::nodes, LineKind::arcs}) {
                all.push_back({kind, row, set});
            }
            if (set.empty()) continue;
            const std::int32_t column = set[random() % set.size()];
            all.push_back({LineKind::nodes_of, column, set});
            all.push_back({LineKind::arcs_of, column, set});
            const auto near = p.near.of(column);
            if (!near.empty()) {
                all.push_back({LineKind::pair, column, {near[random() % near.size()]}});
            }
        }
        every_plan(p, [&](const Choice& plan) {
            std::vector<std::int64_t> value(idx(lines.size()), 0);
            std::vector<std::uint8_t> chosen(idx(p.columns()), 0);
            for (const std::int32_t c : plan) value[idx(c)] = chosen[idx(c)] = 1;
            std::vector<std::int32_t> queue;
            for (std::size_t k = 0; k < root.columns.size() && queue.empty(); ++k) {
                if (chosen[idx(root.columns[k])] == 0) continue;
                queue.push_back(root.columns[k]);
                value[idx(lines.r(k))] = 1;
            }
            chosen[idx(queue.front())] = 0;
            for (std::size_t i = 0; i < queue.size(); ++i) {
                for (const std::int32_t n : p.near.of(queue[i])) {
                    if (chosen[idx(n)] == 0) continue;
                    chosen[idx(n)] = 0;
                    value[idx(lines.y(lines.place(queue[i], n)))] = 1;
                    queue.push_back(n);
                }
            }
            for (const ProofLine& line : all) {
                std::int64_t sum = 0;
                lines.each(line, [&](std::int32_t variable, std::int64_t factor) {
                    sum += factor * value[idx(variable)];
                });
                ASSERT_GE(sum, Lines::least(line.kind)) << name_of(line.kind);
                if (Lines::is_equation(line.kind)) {
                    ASSERT_EQ(sum, Lines::least(line.kind));
                }
            }
        });
    }
}

TEST(BrokenLines, FindsWhatIsBroken) {
    // A row of five columns in a chain, the ends of which have a piece each.
    Problem p;
    for (std::int32_t c = 0; c < 5; ++c) {
        if (c == 0) p.rows_of.to.push_back(0);
        if (c == 4) p.rows_of.to.push_back(1);
        p.rows_of.end_list();
        if (c > 0) p.near.to.push_back(c - 1);
        if (c < 4) p.near.to.push_back(c + 1);
        p.near.end_list();
        p.fixed.push_back(0);
    }
    p.columns_of = transposed(p.rows_of, 2);
    const Root root = root_of(p);
    Lines lines(p, root);
    BrokenLines broken(lines);
    Effort effort{1'000'000};
    Fraction at{{1, 0.5, 0, 1, 1}, std::vector<double>(8, 0), {1}};
    const auto nodes = broken.nodes(at, 10, effort);
    ASSERT_FALSE(nodes.empty());
    std::vector<std::int32_t> named;
    lines.each(nodes.front(), [&](std::int32_t v, int) { named.push_back(v); });
    EXPECT_EQ(named, std::vector<std::int32_t>{2});
    EXPECT_FALSE(broken.arcs(at, 10, effort).empty());
    EXPECT_TRUE(broken.covers(at, 10).empty());
    at.x[4] = 0.25;
    ASSERT_EQ(broken.covers(at, 10).size(), 1U);
    EXPECT_EQ(broken.covers(at, 10).front().of, 1);
    at.y[idx(lines.place(0, 1))] = 0.75;
    ASSERT_EQ(broken.pairs(at, 10).size(), 1U);
    EXPECT_EQ(broken.pairs(at, 10).front().of, 1);
    at = {{1, 1, 1, 1, 1}, std::vector<double>(8, 0), {1}};
    for (std::int32_t c = 1; c < 5; ++c) at.y[idx(lines.place(c - 1, c))] = 1;
    EXPECT_TRUE(broken.nodes(at, 10, effort).empty());
    EXPECT_TRUE(broken.arcs(at, 10, effort).empty());
    EXPECT_TRUE(broken.pairs(at, 10).empty());
}

}  // namespace
}  // namespace vfplan
