// Chains over rows alone: who joins whom, and over how few cells.
#include "engine/joining/chains.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <set>

namespace vfplan {
namespace {

// Rows by hand: pieces of one metre, all seen at the same angle.
OverlapRow row(std::vector<std::int32_t> pieces) {
    CoverageRow out;
    std::sort(pieces.begin(), pieces.end());
    pieces.erase(std::unique(pieces.begin(), pieces.end()), pieces.end());
    for (const std::int32_t p : pieces) out.push_back({p, 1, 0.25F});
    return {out, std::vector<double>(out.size(), 1.0)};
}

std::vector<std::int32_t> span(std::int32_t from, std::int32_t to) {
    std::vector<std::int32_t> out(idx(to - from));
    std::iota(out.begin(), out.end(), from);
    return out;
}

// Candidates that are a component each, and cells.
struct Rows {
    Rows(const std::vector<std::vector<std::int32_t>>& candidates,
         const std::vector<std::vector<std::int32_t>>& cells, const OverlapRule& by)
        : rule(by) {
        for (const auto& r : candidates) {
            component.push_back(static_cast<std::int32_t>(component.size()));
            rows.push_back(row(r));
        }
        for (const auto& r : cells) rows.push_back(row(r));
        local = local_rows(rows);
    }
    JoinProblem problem() const {
        return {local, component, static_cast<std::int64_t>(component.size()), rule};
    }
    Joined joined(int threads = 1) const { return join(Threads(threads), problem()); }

    OverlapRule rule;
    std::vector<std::int32_t> component;
    std::vector<OverlapRow> rows;
    LocalRows local;
};

constexpr OverlapRule half{OverlapRatio::mean_len, 0.5};

TEST(Chains, OneCellJoinsAtATie) {
    // Half of ten and ten, from either side.
    const Rows r({span(0, 10), span(10, 20)}, {span(5, 15)}, half);
    const Joined j = r.joined();
    EXPECT_EQ(j.connectors, std::vector<std::int32_t>{0});
    EXPECT_EQ(j.set_of_component, (std::vector<std::int32_t>{0, 0}));
    const Rows above({span(0, 10), span(10, 20)}, {span(5, 15)}, {OverlapRatio::mean_len, 0.501});
    EXPECT_TRUE(above.joined().connectors.empty());
    EXPECT_EQ(above.joined().set_of_component, (std::vector<std::int32_t>{0, 1}));
}

TEST(Chains, TheShortestOnesAreTaken) {
    // Cells 0 to 3 lead over four steps, 4 and 5 over two.
    const Rows two({span(0, 10), span(20, 30)},
                   {span(4, 14),
                    span(8, 18),
                    span(12, 22),
                    span(16, 26),
                    {5, 6, 7, 8, 9, 12, 13, 14, 15, 16},
                    {12, 13, 14, 15, 16, 20, 21, 22, 23, 24}},
                   half);
    EXPECT_EQ(two.joined().connectors, (std::vector<std::int32_t>{4, 5}));
    const Rows three({span(0, 10), span(20, 30)}, {span(5, 15), span(10, 20), span(15, 25)}, half);
    EXPECT_EQ(three.joined().connectors, (std::vector<std::int32_t>{0, 1, 2}));
    EXPECT_EQ(three.joined().next[0], beside_a_candidate);
    EXPECT_EQ(three.joined().next[1], 0);
}

TEST(Chains, TooManyCellsBesideNoCandidateAreLeftOut) {
    const Rows three({span(0, 10), span(20, 30)}, {span(5, 15), span(10, 20), span(15, 25)}, half);
    const Joined j = join(Threads(1), three.problem(), 10);
    EXPECT_FALSE(j.complete);
    EXPECT_TRUE(j.connectors.empty());
    EXPECT_EQ(j.set_of_cell, (std::vector<std::int32_t>{0, left_out, 1}));
    EXPECT_TRUE(three.joined().complete);
    const Rows two({span(0, 10), span(15, 25)}, {span(5, 15), span(10, 20), {12}, {13}, {14}},
                   half);
    const Joined both = join(Threads(1), two.problem(), 7);
    EXPECT_FALSE(both.complete);
    EXPECT_EQ(both.connectors, (std::vector<std::int32_t>{0, 1}));
}

TEST(Chains, WhatJoinsMostGoesFirst) {
    // Cells 0 and 1 join two each, cell 2 all three.
    const Rows r(
        {span(0, 4), span(10, 14), span(20, 24)},
        {{0, 1, 2, 10, 11, 12}, {10, 11, 12, 20, 21, 22}, {0, 1, 2, 10, 11, 12, 20, 21, 22}},
        {OverlapRatio::min_len, 0.7});
    EXPECT_EQ(r.joined().connectors, std::vector<std::int32_t>{2});
}

TEST(Chains, CellsAloneAreASetOfTheirOwn) {
    const Rows r({span(0, 10), span(40, 50)}, {span(9, 19), span(10, 20), span(60, 70)}, half);
    const Joined j = r.joined();
    EXPECT_TRUE(j.connectors.empty());
    EXPECT_EQ(j.set_of_component, (std::vector<std::int32_t>{0, 1}));
    EXPECT_EQ(j.set_of_cell, (std::vector<std::int32_t>{2, 2, 4}));
    EXPECT_EQ(j.next[0], joins_nothing);
    const std::vector<SetPair> pairs = largest_overlaps(Threads(1), r.problem(), j);
    ASSERT_EQ(pairs.size(), 1U);
    EXPECT_EQ(std::pair(pairs[0].a, pairs[0].b), std::pair(0, 2));
    EXPECT_DOUBLE_EQ(pairs[0].overlap, 0.1);
}

// Components of a graph over all rows, pair by pair; `use` says which cells count.
std::vector<std::size_t> parts(const Rows& r, const std::vector<bool>& use) {
    std::vector<std::size_t> part(r.rows.size());
    std::iota(part.begin(), part.end(), 0U);
    for (std::size_t pass = 0; pass < part.size(); ++pass) {
        bool changed = false;
        for (std::size_t a = 0; a < part.size(); ++a) {
            for (std::size_t b = 0; b < part.size(); ++b) {
                if (!use[a] || !use[b] || part[a] <= part[b]) continue;
                if (!r.rule.enough(overlap(r.rule.ratio, r.rows[a], r.rows[b]))) continue;
                part[a] = part[b];
                changed = true;
            }
        }
        if (!changed) break;
    }
    return part;
}

TEST(Chains, AgreeWithEveryPairOfRandomRows) {
    int joined = 0;
    for (int seed = 1; seed <= 400; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        const auto below = [&](int n) { return static_cast<std::int32_t>(random() % idx(n)); };
        // Rows are stretches with holes, so that neighbours overlap more or less.
        const auto some = [&] {
            const std::int32_t from = below(50);
            std::vector<std::int32_t> out;
            for (std::int32_t p = from; p < from + 4 + below(12); ++p) {
                if (below(5) > 0) out.push_back(p);
            }
            out.push_back(from);
            return out;
        };
        OverlapRule rule{static_cast<OverlapRatio>(seed % 5), 0.1 * (3 + below(6))};
        // Candidates that do not overlap: each a component.
        std::vector<std::vector<std::int32_t>> candidates;
        for (int i = 0; i < 30 && candidates.size() < 6; ++i) {
            candidates.push_back(some());
            const Rows alone(candidates, {}, rule);
            const std::vector<std::size_t> p =
                parts(alone, std::vector<bool>(alone.rows.size(), true));
            if (std::set<std::size_t>(p.begin(), p.end()).size() < p.size()) candidates.pop_back();
        }
        std::vector<std::vector<std::int32_t>> cells;
        for (int i = below(40); i >= 0; --i) cells.push_back(some());
        const Rows r(candidates, cells, rule);
        const std::size_t n = candidates.size();
        const Joined j = r.joined();
        const Joined two = r.joined(2);
        EXPECT_EQ(j.connectors, two.connectors);
        EXPECT_EQ(j.set_of_cell, two.set_of_cell);

        const std::vector<std::size_t> all = parts(r, std::vector<bool>(r.rows.size(), true));
        std::vector<bool> chosen(r.rows.size(), false);
        std::fill(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(n), true);
        for (const std::int32_t c : j.connectors) chosen[n + idx(c)] = true;
        const std::vector<std::size_t> with = parts(r, chosen);
        std::vector<std::int32_t> set = j.set_of_component;
        set.insert(set.end(), j.set_of_cell.begin(), j.set_of_cell.end());
        std::set<std::size_t> ends(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
        if (ends.size() < n) ++joined;
        for (std::size_t a = 0; a < set.size(); ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                EXPECT_EQ(set[a] == set[b], all[a] == all[b]) << a << " and " << b;
            }
        }
        for (std::size_t a = 0; a < n; ++a) {
            for (std::size_t b = 0; b < a; ++b) {
                EXPECT_EQ(with[a] == with[b], all[a] == all[b]) << a << " and " << b;
            }
        }
        // As far apart as the farthest pair says.
        for (const SetPair& p : largest_overlaps(Threads(2), r.problem(), j)) {
            double most = 0;
            for (std::size_t a = 0; a < set.size(); ++a) {
                for (std::size_t b = 0; b < set.size(); ++b) {
                    if (set[a] != p.a || set[b] != p.b) continue;
                    most = std::max(most, overlap(rule.ratio, r.rows[a], r.rows[b]));
                }
            }
            EXPECT_NEAR(p.overlap, most, 1e-12);
            EXPECT_FALSE(rule.enough(p.overlap));
        }
    }
    EXPECT_GT(joined, 100);
}

}  // namespace
}  // namespace vfplan
