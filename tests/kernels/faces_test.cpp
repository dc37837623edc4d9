// Which areas surround a face, against counting crossings of every ring from the middle of every
// triangle.
#include "kernels/faces.h"

#include <gtest/gtest.h>

#include <random>

namespace vfplan {
namespace {

Triangulation triangles_of(const Noded& noded) {
    std::vector<Wall> walls;
    for (const Noded::Edge& e : noded.edges) {
        walls.emplace_back();
        walls.back().a = as_vec(e.a);
        walls.back().b = as_vec(e.b);
    }
    return triangulate(walls, {}, 2);
}

bool odd(const Noded& noded, std::int32_t label, const Vec2d& p) {
    bool inside = false;
    for (std::size_t e = 0; e < noded.edges.size(); ++e) {
        for (const std::int32_t of : noded.labels_of(e)) {
            if (of != label) continue;
            const Vec2d a = as_vec(noded.edges[e].a);
            const Vec2d b = as_vec(noded.edges[e].b);
            if ((a.y() > p.y()) == (b.y() > p.y())) continue;
            if (a.x() + (p.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()) > p.x())
                inside = !inside;
        }
    }
    return inside;
}

TEST(Faces, KindsAreThoseOfTheRingsAround) {
    int with_two_kinds = 0;
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(seed);
        const auto below = [&](std::uint64_t n) { return static_cast<std::int64_t>(random() % n); };
        const auto size = static_cast<std::uint64_t>(fine_steps << (4 + below(8)));
        std::vector<LabelledSegment> segments;
        std::vector<AreaKind> kind_of;
        for (std::int32_t label = 0; label < 2 + below(6); ++label) {
            kind_of.push_back(static_cast<AreaKind>(below(4) - 1));  // a line now and then
            for (std::int64_t rings = 1 + below(3); rings > 0; --rings) {
                std::vector<LatticePoint> ring(3 + static_cast<std::size_t>(below(5)));
                for (LatticePoint& p : ring) p = {below(size), below(size)};
                for (std::size_t i = 0; i < ring.size(); ++i) {
                    segments.push_back({ring[i], ring[(i + 1) % ring.size()], label});
                }
            }
        }
        const Noded noded = node(segments);
        const Triangulation triangles = triangles_of(noded);
        const std::vector<Kinds> got = kinds_around(triangles, noded, kind_of);
        ASSERT_EQ(got.size(), triangles.triangles.size());
        for (std::size_t t = 0; t < got.size(); ++t) {
            Vec2d middle(0, 0);
            for (const std::int32_t v : triangles.triangles[t].vertex) {
                middle += triangles.vertices[static_cast<std::size_t>(v)] / 3;
            }
            Kinds want = 0;
            for (std::size_t label = 0; label < kind_of.size(); ++label) {
                if (kind_of[label] == line_kind) continue;
                if (odd(noded, static_cast<std::int32_t>(label), middle)) {
                    want = static_cast<Kinds>(want | 1U << static_cast<unsigned>(kind_of[label]));
                }
            }
            ASSERT_EQ(got[t], want);
            with_two_kinds += (want & (want - 1)) != 0 ? 1 : 0;
        }
    }
    EXPECT_GT(with_two_kinds, 1000);
}

TEST(Faces, NothingHasNone) { EXPECT_TRUE(kinds_around({}, {}, {}).empty()); }

}  // namespace
}  // namespace vfplan
