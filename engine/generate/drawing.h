// What the site generators share: repeatable random numbers, millimetre polygons, GeoJSON.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "kernels/vec.h"

namespace vfplan::generate {

// Raw engine output only: the standard fixes it, while distributions differ between libraries.
class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    // A stream of its own for part (a, b) of a site, however many numbers other parts drew.
    Random(std::uint64_t seed, std::uint64_t a, std::uint64_t b)
        : engine_(mixed(mixed(mixed(seed) + a) + b)) {}

    double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }  // [0, 1)
    double range(double from, double to) { return from + (to - from) * unit(); }
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    int between(int from, int to) { return from + below(to - from + 1); }  // both ends included
    bool chance(double p) { return unit() < p; }

private:
    static std::uint64_t mixed(std::uint64_t v) {  // SplitMix64
        v += 0x9E3779B97F4A7C15U;
        v = (v ^ (v >> 30U)) * 0xBF58476D1CE4E5B9U;
        v = (v ^ (v >> 27U)) * 0x94D049BB133111EBU;
        return v ^ (v >> 31U);
    }

    std::mt19937_64 engine_;
};

// Coordinates leave the generators as whole millimetres: no printing of doubles, equal bytes
// everywhere, and neighbours that share a corner share it exactly.
struct PointMm {
    std::int64_t x = 0;
    std::int64_t y = 0;
    friend bool operator==(const PointMm&, const PointMm&) = default;
};
using RingMm = std::vector<PointMm>;  // closed; the first point is not repeated

inline PointMm to_mm(const Vec2d& p) {
    return {static_cast<std::int64_t>(std::floor(p.x() * 1000 + 0.5)),
            static_cast<std::int64_t>(std::floor(p.y() * 1000 + 0.5))};
}
inline RingMm to_mm(const std::vector<Vec2d>& ring) {
    RingMm out;
    for (const Vec2d& p : ring) out.push_back(to_mm(p));
    return out;
}

// Positive for counter-clockwise rings.
double area_m2(const RingMm& ring);

struct BoxMm {
    PointMm min;
    PointMm max;
};
BoxMm box_of(const RingMm& ring);

// "12.345"
void append_metres(std::string& out, std::int64_t mm);

// A FeatureCollection in plane metres, one feature a line.
class GeoJson {
public:
    explicit GeoJson(const std::string& name);
    // `extra` goes behind the class into the properties: R"("label":"hall")"
    void polygon(std::string_view cls, std::string_view extra, const RingMm& outer,
                 const RingMm& hole = {});  // hole: clockwise
    void line(std::string_view cls, const RingMm& points);
    std::string finish();  // call once, last

private:
    void begin(std::string_view cls, std::string_view extra, const char* type);
    void ring(const RingMm& points, bool closed);

    std::string out_;
    bool first_ = true;
};

// Rotations by rational numbers (Pythagorean triples), from -43.6 to 43.6 degrees.
inline constexpr int direction_count = 13;
Vec2d direction(int i);

inline Vec2d left_of(const Vec2d& d) { return {-d.y(), d.x()}; }

std::string fixed(double value, int decimals);  // "12.3"
std::string grouped(std::int64_t value);        // "12,345"

}  // namespace vfplan::generate
