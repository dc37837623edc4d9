// Snap rounding against its definition: edges meet at their ends only, and every segment is an
// unbroken chain of edges that keeps within half a pixel of it.
#include "kernels/noding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "kernels/error.h"

namespace vfplan {
namespace {

using Segments = std::vector<LabelledSegment>;

int sign(Wide v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

// p lies on the closed segment ab.
bool on(const LatticePoint& a, const LatticePoint& b, const LatticePoint& p) {
    return turn(a, b, p) == 0 && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
           std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool meet_between_ends(const Noded::Edge& e, const Noded::Edge& f) {
    for (const LatticePoint& p : {f.a, f.b}) {
        if (p != e.a && p != e.b && on(e.a, e.b, p)) return true;
    }
    for (const LatticePoint& p : {e.a, e.b}) {
        if (p != f.a && p != f.b && on(f.a, f.b, p)) return true;
    }
    return sign(turn(e.a, e.b, f.a)) * sign(turn(e.a, e.b, f.b)) < 0 &&
           sign(turn(f.a, f.b, e.a)) * sign(turn(f.a, f.b, e.b)) < 0;
}

double distance_to(const LabelledSegment& s, const LatticePoint& pixel) {
    const auto vec = [](const LatticePoint& p, double scale) {
        return std::pair(static_cast<double>(p.x) * scale, static_cast<double>(p.y) * scale);
    };
    const auto [ax, ay] = vec(s.a, 1.0 / fine_steps);
    const auto [bx, by] = vec(s.b, 1.0 / fine_steps);
    const auto [px, py] = vec(pixel, 1);
    const double ex = bx - ax;
    const double ey = by - ay;
    const double n = ex * ex + ey * ey;
    const double t = n > 0 ? std::clamp(((px - ax) * ex + (py - ay) * ey) / n, 0.0, 1.0) : 0;
    return std::hypot(ax + t * ex - px, ay + t * ey - py);
}

void expect_sound(const Segments& segments, const Noded& noded) {
    for (std::size_t i = 0; i < noded.edges.size(); ++i) {
        ASSERT_LT(noded.edges[i].a, noded.edges[i].b);
        for (std::size_t k = i + 1; k < noded.edges.size(); ++k) {
            ASSERT_FALSE(meet_between_ends(noded.edges[i], noded.edges[k]));
        }
    }
    // By label, how often an edge end lies at a node, and the nodes of the label's segments.
    std::map<std::int32_t, std::map<LatticePoint, int>> ends;
    for (std::size_t e = 0; e < noded.edges.size(); ++e) {
        for (const std::int32_t label : noded.labels_of(e)) {
            ++ends[label][noded.edges[e].a];
            ++ends[label][noded.edges[e].b];
        }
    }
    for (const LabelledSegment& s : segments) {
        // A label of its own: its edges are a chain from the pixel of one end to that of the other.
        const LatticePoint a = pixel_of(s.a);
        const LatticePoint b = pixel_of(s.b);
        const auto& nodes = ends[s.label];
        if (a == b) {
            ASSERT_TRUE(nodes.empty());
            continue;
        }
        ASSERT_TRUE(nodes.contains(a) && nodes.contains(b));
        for (const auto& [node, met] : nodes) {
            ASSERT_EQ(met, node == a || node == b ? 1 : 2);
            ASSERT_LE(distance_to(s, node), std::sqrt(0.5) + 1e-9);
        }
    }
}

Segments random_segments(std::mt19937_64& random) {
    const auto below = [&](std::int64_t n) {
        return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(n));
    };
    // Small worlds have many pixels shared, large ones long flat angles; ends on the borders of
    // pixels are as frequent as the lattice's own.
    const std::int64_t size = std::int64_t{1} << (3 + below(20));
    const std::int64_t unit = below(3) == 0 ? 1 : below(2) == 0 ? fine_steps / 2 : fine_steps;
    const auto place = [&] {
        return LatticePoint{below(size * fine_steps / unit) * unit,
                            below(size * fine_steps / unit) * unit};
    };
    Segments out(3 + static_cast<std::size_t>(below(25)));
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = {place(), place(), static_cast<std::int32_t>(i)};
        if (i == 0 || below(3) > 0) continue;
        const LabelledSegment& other =
            out[static_cast<std::size_t>(below(static_cast<std::int64_t>(i)))];
        const auto nudge = [&](LatticePoint p) {
            return LatticePoint{p.x + below(2 * fine_steps) - fine_steps,
                                p.y + below(2 * fine_steps) - fine_steps};
        };
        switch (below(4)) {
            case 0:
                out[i].a = other.a;
                break;  // a common end
            case 1:
                out[i].a = nudge(other.b);
                break;  // a near one
            case 2:
                out[i].a = nudge(other.a), out[i].b = nudge(other.b);
                break;  // nearly the same
            default:    // ends on it
                out[i].a = nudge({(other.a.x + other.b.x) / 2, (other.a.y + other.b.y) / 2});
        }
    }
    return out;
}

TEST(Noding, EdgesMeetAtTheirEndsAndSegmentsStayWhole) {
    constexpr int rounds = 3000;
    std::size_t split = 0;
    for (std::uint64_t seed = 1; seed <= rounds; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(seed);
        Segments segments = random_segments(random);
        const Noded noded = node(segments);
        expect_sound(segments, noded);
        if (testing::Test::HasFatalFailure()) return;
        split += noded.labels.size() - segments.size();
        // Order and direction do not matter.
        std::shuffle(segments.begin(), segments.end(), random);
        for (LabelledSegment& s : segments) {
            if (random() % 2 == 0) std::swap(s.a, s.b);
        }
        const Noded again = node(segments);
        ASSERT_EQ(again.edges.size(), noded.edges.size());
        for (std::size_t e = 0; e < noded.edges.size(); ++e) {
            ASSERT_EQ(again.edges[e].a, noded.edges[e].a);
            ASSERT_EQ(again.edges[e].b, noded.edges[e].b);
        }
        ASSERT_EQ(again.labels, noded.labels);
    }
    EXPECT_GT(split, 10U * rounds);
}

TEST(Noding, CrossingsOfOneLabelAreTold) {
    const std::int64_t m = 100 * fine_steps;
    const Segments bow_tie = {
        {{0, 0}, {m, m}, 0}, {{m, m}, {m, 0}, 0}, {{m, 0}, {0, m}, 0}, {{0, m}, {0, 0}, 0}};
    const Noded noded = node(bow_tie);
    ASSERT_EQ(noded.self_crossings.size(), 1U);
    EXPECT_EQ(noded.self_crossings[0].at, (LatticePoint{50, 50}));
    EXPECT_EQ(noded.edges.size(), 6U);
}

TEST(Noding, ASegmentOfNoLengthMakesANode) {
    const Segments segments = {{{0, 0}, {10 * fine_steps, 0}, 0},
                               {{4 * fine_steps, 3}, {4 * fine_steps, 3}, 1}};
    const Noded noded = node(segments);
    ASSERT_EQ(noded.edges.size(), 2U);
    EXPECT_EQ(noded.edges[0].b, (LatticePoint{4, 0}));
}

TEST(Noding, TooFarApartIsRefused) {
    EXPECT_THROW(node(Segments{{{0, 0}, {farthest_fine + 1, 0}, 0}}), InputError);
    EXPECT_TRUE(node(Segments{}).edges.empty());
}

}  // namespace
}  // namespace vfplan
