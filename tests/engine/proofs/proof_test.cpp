#include "engine/proofs/proof.h"

#include <gtest/gtest.h>

#include <sstream>

#include "engine/proofs/cases.h"
#include "engine/search/improve.h"
#include "io/tables/certificate_text.h"
#include "kernels/error.h"
#include "tests/engine/proofs/checked.h"
#include "tests/engine/search/small_problems.h"

namespace vfplan {
namespace {

using test::fewest;
using test::random_problem;
using test::wrong_with;

// Some plan, not a good one.
Choice some_plan(const Problem& p) {
    Choice all;
    for (std::int32_t c = 0; c < p.columns(); ++c) all.push_back(c);
    return improve(p, all, {0, 1});
}

Problem small_problem(std::uint64_t seed) {
    return random_problem(seed, 2 + static_cast<std::int32_t>(seed % 12), 12, seed % 3 == 0);
}

TEST(Proof, NoBoundIsAboveTheFewestStationsAndProofsHold) {
    std::int64_t weighed_closed = 0;
    std::int64_t better = 0;
    for (std::uint64_t seed = 0; seed < 1500; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p = small_problem(seed);
        const auto best = static_cast<std::int64_t>(fewest(p));
        const Choice plan = some_plan(p);
        const NetworkProof fast = weighed_proof(p, plan);
        ASSERT_LE(fast.bound, best);
        ASSERT_EQ(wrong_with(p, fast), "");
        weighed_closed += fast.bound == best ? 1 : 0;
        const Proven proven = prove(p, plan, 20);
        ASSERT_TRUE(is_plan(p, proven.plan));
        ASSERT_LE(proven.plan.size(), plan.size());
        better += proven.plan.size() < plan.size() ? 1 : 0;
        ASSERT_EQ(wrong_with(p, proven.proof), "");
        // So small a problem is closed.
        ASSERT_EQ(proven.proof.bound, best);
        ASSERT_EQ(static_cast<std::int64_t>(proven.plan.size()), best);
        NetworkProof bold = proven.proof;
        ++bold.bound;
        ASSERT_NE(wrong_with(p, bold), "");
    }
    EXPECT_GT(weighed_closed, 700);
    EXPECT_GT(better, 50);
}

// With little effort proofs end anywhere, and hold all the same.
TEST(Proof, HoldsWhereverItEnds) {
    std::int64_t open = 0;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p = small_problem(seed);
        const Root root = root_of(p);
        for (const bool ways : {false, true}) {
            for (const std::int64_t effort : {0, 3000, 12000, 50000}) {
                Lines lines(p, root);
                Cases cases(lines, some_plan(p), ways, {});
                Effort left{effort};
                cases.run(left, true);
                NetworkProof proof;
                proof.root_piece = root.row;
                proof.root_station = root.column;
                cases.write(proof);
                ASSERT_LE(proof.bound, static_cast<std::int64_t>(fewest(p)));
                ASSERT_EQ(wrong_with(p, proof), "");
                open += cases.is_closed() ? 0 : 1;
            }
        }
    }
    EXPECT_GT(open, 300);
}

// Larger than can be tried out: the same each time, and what is said to be closed has no better
// plan that a search would find.
TEST(Proof, IsTheSameEachTime) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p = random_problem(seed, 60, 150, seed % 2 == 0);
        const Choice plan = some_plan(p);
        const Proven first = prove(p, plan, 5);
        const Proven second = prove(p, plan, 5);
        EXPECT_EQ(wrong_with(p, first.proof), "");
        EXPECT_EQ(text_of({{first.proof}}), text_of({{second.proof}}));
        EXPECT_EQ(first.plan, second.plan);
        EXPECT_GE(improve(p, plan, {3000, seed}).size(), idx(first.proof.bound));
    }
}

// Changes of a text: a line gone, twice or elsewhere, a number another one.
std::vector<std::string> changed(const std::vector<std::string>& lines, std::size_t at,
                                 std::uint64_t random) {
    std::vector<std::string> out;
    const auto keep = [&](std::vector<std::string> all) {
        std::string text;
        for (const std::string& line : all) text += line + "\n";
        out.push_back(std::move(text));
    };
    auto without = lines;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(at));
    keep(without);
    auto twice = lines;
    twice.insert(twice.begin() + static_cast<std::ptrdiff_t>(at), lines[at]);
    keep(twice);
    auto moved = lines;
    std::swap(moved[at], moved[random % lines.size()]);
    keep(moved);
    std::istringstream in(lines[at]);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    for (std::size_t w = 1; w < words.size(); ++w) {
        for (const std::int64_t by : {-1, 1, static_cast<int>(random % 9) + 2}) {
            auto others = words;
            try {
                others[w] = std::to_string(std::stoll(words[w]) + by);
            } catch (const std::invalid_argument&) {
                others[w] = Names<LineKind>::all[random % Names<LineKind>::all.size()];
            }
            auto all = lines;
            all[at].clear();
            for (const std::string& word : others) {
                all[at] += all[at].empty() ? word : " " + word;
            }
            keep(all);
        }
    }
    return out;
}

TEST(Proof, AChangedOneIsRefusedOrHolds) {
    std::int64_t refused = 0;
    std::int64_t unreadable = 0;
    std::int64_t weaker = 0;
    std::int64_t divided = 0;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        SCOPED_TRACE(seed);
        const Problem p = small_problem(seed);
        const auto best = static_cast<std::int64_t>(fewest(p));
        // By cases at once, so that there are some.
        const Root root = root_of(p);
        Lines lines(p, root);
        Cases cases(lines, some_plan(p), seed % 2 == 0, {});
        Effort effort{10'000'000};
        cases.run(effort, true);
        NetworkProof proof;
        if (seed % 4 == 0) {
            proof = prove(p, some_plan(p), 20).proof;
        } else {
            proof.root_piece = root.row;
            proof.root_station = root.column;
            cases.write(proof);
        }
        divided += proof.cases.size() > 1 ? 1 : 0;
        const std::string text = text_of({{proof}});
        ASSERT_EQ(text_of(certificate_of(text, "it")), text);
        std::vector<std::string> rows;
        std::istringstream in(text);
        for (std::string line; std::getline(in, line);) rows.push_back(line);
        for (std::size_t at = 0; at < rows.size(); ++at) {
            for (const std::string& other : changed(rows, at, seed * 31 + at * 7)) {
                Certificate read;
                try {
                    read = certificate_of(other, "it");
                } catch (const IoError&) {
                    ++unreadable;
                    continue;
                }
                if (read.networks.size() != 1 || wrong_with(p, read.networks[0]) != "") {
                    ++refused;
                    continue;
                }
                ASSERT_LE(read.networks[0].bound, best) << other;
                ++weaker;
            }
        }
    }
    EXPECT_GT(refused, 1000);
    EXPECT_GT(unreadable, 1000);
    EXPECT_GT(weaker, 1000);
    EXPECT_GT(divided, 10);
}

}  // namespace
}  // namespace vfplan
