// Little sites made by chance, as hostile as they come.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/io/site/features.h"

namespace vfplan::test {

inline std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
    const char* wanted = std::getenv(name);
    return wanted == nullptr ? otherwise : std::strtoull(wanted, nullptr, 10);
}

// Calls f(seed) for each of VFPLAN_RANDOM_SITES, else of `otherwise`; VFPLAN_RANDOM_FIRST=SEED
// VFPLAN_RANDOM_SITES=1 repeats one that failed.
template <class F>
void for_sites(F&& f, std::uint64_t otherwise = 300) {
    const std::uint64_t first = from_environment("VFPLAN_RANDOM_FIRST", 1);
    const std::uint64_t sites = from_environment("VFPLAN_RANDOM_SITES", otherwise);
    for (std::uint64_t seed = first; seed < first + sites; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        f(seed);
    }
}

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double between(double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(engine_);
    }
    bool one_in(int n) { return engine_() % static_cast<std::uint64_t>(n) == 0; }
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    // A gap or an overlap that snapping closes, opens or bends.
    double hair() { return (one_in(2) ? 1 : -1) * std::pow(10, between(-4, -2.5)); }

private:
    std::mt19937_64 engine_;
};

inline Ring turned(Ring ring, double angle, const Vec2d& by) {
    for (Vec2d& p : ring) {
        p = Vec2d(p.x() * std::cos(angle) - p.y() * std::sin(angle),
                  p.x() * std::sin(angle) + p.y() * std::cos(angle)) +
            by;
    }
    return ring;
}

inline FeatureSet shifted(FeatureSet set, const Vec2d& by) {
    for (Feature& f : set.features) each_point(f, [&](Vec2d& v) { v += by; });
    return set;
}

inline Ring random_building(Random& random) {
    const double w = random.between(1, 12);
    const double h = random.between(1, 12);
    Ring ring = box_ring(0, 0, w, h);
    if (random.one_in(4)) ring = {{0, 0}, {w, 0}, {w, h / 2}, {w / 3, h / 2}, {w / 3, h}, {0, h}};
    if (random.one_in(12)) std::swap(ring[1], ring[2]);  // a bow tie
    if (random.one_in(5)) {                              // a spike or a corner more
        const Vec2d middle = (ring[0] + ring[1]) / 2;
        ring.insert(ring.begin() + 1, middle + Vec2d(0, random.hair()));
    }
    const double angle = random.one_in(3) ? random.between(0, 6.28) : random.below(8) * M_PI / 4;
    return turned(ring, angle, {random.between(0, 15), random.between(0, 15)});
}

inline FeatureSet random_town(Random& random) {
    FeatureSet set;
    std::vector<Ring> rings;
    const int buildings = 2 + random.below(5);
    for (int i = 0; i < buildings; ++i) {
        Ring ring = random_building(random);
        if (!rings.empty() && random.one_in(2)) {
            const Ring& other =
                rings[static_cast<std::size_t>(random.below(static_cast<int>(rings.size())))];
            const Vec2d e = other[1] - other[0];
            const Vec2d away = Vec2d(e.y(), -e.x()).normalized();
            const Vec2d hair = away * random.hair();
            switch (random.below(4)) {
                case 0:
                    ring = other;
                    break;  // drawn twice
                case 1:     // the same with a hair between
                    for (std::size_t k = 0; k < other.size(); ++k) ring = turned(other, 0, hair);
                    break;
                case 2:  // wall to wall, a T-junction at its ends
                    ring = {other[0] + 0.3 * e + hair, other[0] + 0.3 * e + 4 * away,
                            other[0] + 1.3 * e + 4 * away, other[0] + 1.3 * e + hair};
                    break;
                default:  // nested
                    ring = {other[0] + 0.1 * e - 0.2 * away, other[0] + 0.4 * e - 0.2 * away,
                            other[0] + 0.4 * e - 0.9 * away};
            }
        }
        std::vector<Ring> holes;
        if (random.one_in(5) && ring.size() == 4) {
            const Vec2d middle = (ring[0] + ring[2]) / 2;
            Ring hole = ring;
            for (Vec2d& p : hole) p = middle + 0.6 * (p - middle);
            holes.push_back(hole);
        }
        rings.push_back(ring);
        add_polygon(set, Role::building, ring, holes);
    }
    const int fences = random.below(3);
    for (int i = 0; i < fences; ++i) {
        Line line;
        for (int k = 2 + random.below(3); k > 0; --k) {
            line.emplace_back(random.between(-3, 20), random.between(-3, 20));
        }
        if (random.one_in(2)) line.front() = rings[0][0] + Vec2d(random.hair(), random.hair());
        add_line(set, Role::wall, line);
    }
    const double far = std::array{0.0, 4.9e5, 6.7e6}[static_cast<std::size_t>(random.below(3))];
    return shifted(std::move(set), {far, far / 3});
}

inline FeatureSet random_plan(Random& random) {
    FeatureSet set;
    const double w = random.between(5, 12);
    const double h = random.between(4, 9);
    const double angle = random.one_in(2) ? 0 : random.between(0, 6.28);
    const auto place = [&](const Ring& ring) { return turned(ring, angle, {0, 0}); };
    const auto box = [&](double x0, double y0, double x1, double y1) {
        return place(box_ring(x0, y0, x1, y1));
    };
    const int kind = random.below(3);
    if (kind == 0) {
        add_polygon(set, Role::outline, box(0, 0, w, h));
    } else if (kind == 1) {  // thick walls around a room
        add_polygon(set, Role::wall, box(-0.3, -0.3, w + 0.3, h + 0.3), {box(0, 0, w, h)});
        if (random.one_in(2)) {
            const double off = random.one_in(2) ? 0 : random.between(0.001, 0.05);
            add_polygon(set, Role::room, box(off, off, w - off, h - off));
        }
    } else {
        Line line = box(0, 0, w, h);
        line.push_back(line.front());
        add_line(set, Role::wall, line);
    }
    // A partition with a door, single or double.
    if (random.one_in(2)) {
        const double x = random.between(0.3, 0.7) * w;
        const double door = random.between(0.2, h - 1.2);
        const int lines = 1 + random.below(2);
        for (int k = 0; k < lines; ++k) {
            const double at = x + k * random.between(0.05, 0.25);
            add_line(set, Role::wall, place({{at, 0}, {at, door}}));
            add_line(set, Role::wall, place({{at, door + 0.9}, {at, h}}));
            if (k == 0) add_line(set, Role::door, place({{at, door}, {at, door + 0.9}}));
        }
    }
    for (int i = random.below(4); i > 0; --i) {  // cupboards before walls
        const double gap = random.one_in(3) ? std::abs(random.hair()) : random.between(0.01, 0.2);
        const double x = random.between(0.2, w - 1.5);
        const Role role = random.one_in(2) ? Role::wall : Role::obstacle;
        add_polygon(set, role, box(x, gap, x + random.between(0.3, 1.2), gap + 0.5));
    }
    for (int i = random.below(4); i > 0; --i) {  // pilasters and boards
        const double y = random.between(0.2, h - 1);
        const double out = random.between(0.02, 0.3);
        add_polygon(
            set, Role::wall,
            box(random.one_in(2) ? 0 : random.hair(), y, out, y + random.between(0.1, 0.6)));
    }
    for (int i = random.below(3); i > 0; --i) {  // pillars
        const double x = random.between(0.5, w - 1);
        const double y = random.between(0.5, h - 1);
        add_polygon(set, Role::wall, box(x, y, x + 0.3, y + 0.3));
    }
    const double far = std::array{0.0, 4.9e5, 6.7e6}[static_cast<std::size_t>(random.below(3))];
    return shifted(std::move(set), {far, far / 3});
}

}  // namespace vfplan::test
