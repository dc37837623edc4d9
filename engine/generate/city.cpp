// A large city: quarters between jittered avenues, each filled with blocks of its own kind, and a
// river through them. Every quarter draws from its own random stream.
#include "engine/generate/city.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/generate/drawing.h"

namespace vfplan::generate {
namespace {

// Counter-clockwise: south-west, south-east, north-east, north-west; convex.
using Quad = std::array<Vec2d, 4>;

Vec2d inside(const Quad& q, double u, double v) {
    return (1 - v) * ((1 - u) * q[0] + u * q[1]) + v * ((1 - u) * q[3] + u * q[2]);
}

// Every side moved inwards by d.
Quad inset(const Quad& q, double d) {
    Quad out;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d& p = q[i];
        const Vec2d a = (p - q[(i + 3) % 4]).normalized();
        const Vec2d b = (q[(i + 1) % 4] - p).normalized();
        // p + d * (left of a), moved along a until it is d away from the second side too.
        const double t = (d - d * left_of(a).dot(left_of(b))) / a.dot(left_of(b));
        out[i] = p + d * left_of(a) + t * a;
    }
    return out;
}

// Whether all of a ring keeps `margin` from the sides of q.
bool within(const Quad& q, const std::vector<Vec2d>& ring, double margin) {
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2d n = left_of((q[(i + 1) % 4] - q[i]).normalized());
        for (const Vec2d& p : ring) {
            if ((p - q[i]).dot(n) < margin) return false;
        }
    }
    return true;
}

// The part of a block in front of its southern (0) or northern (1) street, which comes first.
Quad half_of(const Quad& q, int side) {
    const Vec2d west = 0.5 * (q[0] + q[3]);
    const Vec2d east = 0.5 * (q[1] + q[2]);
    return side == 0 ? Quad{q[0], q[1], east, west} : Quad{q[2], q[3], west, east};
}

enum class Kind { perimeter, detached, rows, slabs, towers, park };

class City {
public:
    City(std::uint64_t seed, double size_m)
        : seed_(seed),
          size_m_(size_m),
          n_(std::max(2, static_cast<int>(std::floor(size_m / 420)))),
          json_("Synthetic city, seed " + std::to_string(seed) + ", " + fixed(size_m / 1000, 2) +
                " km") {
        Random r(seed_, 2, 0);
        double x = size_m_ * r.range(0.3, 0.7);
        // The river wanders, but stays in the middle half of the city.
        for (int i = 0; i * river_step < size_m_ + river_step; ++i) {
            river_.push_back(x);
            x = std::clamp(x + r.range(-0.45, 0.45) * river_step, 0.25 * size_m_, 0.75 * size_m_);
        }
        river_half_ = std::min(12 + size_m_ / 150, 70.0);
        // Suburbs begin where real cities have them; a small square is cut from the middle of one.
        core_m_ = std::clamp(size_m_ / 2, 2200.0, 9000.0);
    }

    GenerateReport run() {
        for (int j = 0; j < n_; ++j) {
            for (int i = 0; i < n_; ++i) quarter(i, j);
        }
        const double km2 = size_m_ * size_m_ / 1e6;
        std::string text = "synthetic city, seed " + std::to_string(seed_) + "\n";
        text += "  buildings " + grouped(count_) + " (" +
                fixed(static_cast<double>(count_) / km2, 0) + " per km2), built area " +
                grouped(std::llround(area_m2_)) + " m2 (" + fixed(area_m2_ / km2 / 1e4, 1) +
                " %), mean footprint " + fixed(area_m2_ / static_cast<double>(count_), 1) + " m2\n";
        text += "  extent " + fixed(static_cast<double>(extent_.max.x - extent_.min.x) / 1000, 1) +
                " x " + fixed(static_cast<double>(extent_.max.y - extent_.min.y) / 1000, 1) +
                " m, " + std::to_string(n_ * n_) + " quarters: ";
        constexpr std::array<const char*, 6> names{
            "perimeter blocks", "detached houses", "row houses", "slabs", "towers", "parks"};
        for (std::size_t k = 0; k < names.size(); ++k) {
            text += (k == 0 ? "" : ", ") + std::to_string(quarters_[k]) + " " + names[k];
        }
        text += "\n  " + grouped(courtyards_) + " buildings around a courtyard\n";
        return {json_.finish(), text};
    }

private:
    static constexpr double river_step = 350;
    static constexpr double street = 7;  // half the width of a street between blocks

    // Crossing of avenues; on the city's border it only moves along the border.
    Vec2d node(int i, int j) const {
        Random r(seed_, 3, static_cast<std::uint64_t>(j) * 100000 + static_cast<std::uint64_t>(i));
        const double cell = size_m_ / n_;
        const double dx = r.range(-0.24, 0.24) * cell;
        const double dy = r.range(-0.24, 0.24) * cell;
        return {cell * i + (i == 0 || i == n_ ? 0 : dx), cell * j + (j == 0 || j == n_ ? 0 : dy)};
    }

    Kind kind_of(Random& r, const Vec2d& middle) const {
        const double d = (middle - Vec2d::Constant(size_m_ / 2)).norm() / core_m_;
        // Shares of perimeter, rows, slabs, towers, park; the rest is detached.
        const std::array<double, 5> shares =
            d < 0.35   ? std::array<double, 5>{0.78, 0.04, 0.03, 0.08, 0.07}
            : d < 0.75 ? std::array<double, 5>{0.34, 0.20, 0.10, 0.06, 0.08}
                       : std::array<double, 5>{0.03, 0.14, 0.06, 0.03, 0.09};
        constexpr std::array<Kind, 5> kinds{Kind::perimeter, Kind::rows, Kind::slabs, Kind::towers,
                                            Kind::park};
        double u = r.unit();
        for (std::size_t k = 0; k < kinds.size(); ++k) {
            if (u < shares[k]) return kinds[k];
            u -= shares[k];
        }
        return Kind::detached;
    }

    void quarter(int i, int j) {
        Random r(seed_, 4, static_cast<std::uint64_t>(j) * 100000 + static_cast<std::uint64_t>(i));
        const Quad outer{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)};
        Quad q = inset(outer, 9);                                           // half an avenue
        if (r.chance(0.5)) std::rotate(q.begin(), q.begin() + 1, q.end());  // streets the other way
        const Kind kind = kind_of(r, inside(q, 0.5, 0.5));
        ++quarters_[static_cast<std::size_t>(kind)];
        if (kind == Kind::park) {
            park(r, q);
            return;
        }
        // Blocks about as large as their kind likes them.
        constexpr std::array<std::array<double, 2>, 5> block{
            {{112, 86}, {150, 74}, {130, 76}, {190, 130}, {170, 170}}};
        const auto& [w, h] = block[static_cast<std::size_t>(kind)];
        const double length = 0.5 * ((q[1] - q[0]).norm() + (q[2] - q[3]).norm());
        const double height = 0.5 * ((q[3] - q[0]).norm() + (q[2] - q[1]).norm());
        const int nu =
            std::max(1, static_cast<int>(std::floor(length / (w * r.range(0.88, 1.12)) + 0.5)));
        const int nv =
            std::max(1, static_cast<int>(std::floor(height / (h * r.range(0.88, 1.12)) + 0.5)));
        for (int b = 0; b < nv; ++b) {
            for (int a = 0; a < nu; ++a) {
                const auto at = [&](int u, int v) {
                    return inside(q, static_cast<double>(u) / nu, static_cast<double>(v) / nv);
                };
                const Quad blk =
                    inset({at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b + 1)}, street);
                if (kind == Kind::perimeter) {
                    perimeter(r, blk);
                } else if (kind == Kind::detached) {
                    detached(r, blk);
                } else if (kind == Kind::rows) {
                    rows(r, blk);
                } else {
                    estate(r, blk, kind == Kind::towers);
                }
            }
        }
    }

    // A closed frame of touching houses around a courtyard, now and then one single building.
    void perimeter(Random& r, const Quad& blk) {
        const double depth = r.range(11, 14);
        if (r.chance(0.05)) return;  // a square
        const Quad in = inset(blk, depth);
        for (std::size_t k = 0; k < 4; ++k) {
            // Too narrow for a court: sides would cross.
            if ((in[(k + 1) % 4] - in[k]).dot(blk[(k + 1) % 4] - blk[k]) < 100) return;
        }
        if (r.chance(0.12)) {
            courtyard(blk, in);
            return;
        }
        const double gate = r.chance(0.5) ? r.unit() : 2;  // a missing house leads into the court
        // Cuts run from the street to the court; corner houses take both ends of two sides.
        std::array<std::vector<std::array<Vec2d, 2>>, 4> cuts;
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec2d& a = in[k];
            const Vec2d& b = in[(k + 1) % 4];
            const Vec2d out = -left_of((b - a).normalized()) * depth;
            const double length = (b - a).norm();
            const double corner = r.range(2, 6);
            double s = corner;
            while (s < length - corner) {
                const Vec2d p = a + (b - a) * (s / length);
                cuts[k].push_back({p + out, p});
                const double w = r.range(15, 24);
                s = s + w > length - corner - 7 && s < length - corner - 0.01 ? length - corner
                                                                              : s + w;
            }
            const Vec2d p = b - (b - a) * (corner / length);
            cuts[k].push_back({p + out, p});
        }
        for (std::size_t k = 0; k < 4; ++k) {
            for (std::size_t c = 0; c + 1 < cuts[k].size(); ++c) {
                const auto& [o0, i0] = cuts[k][c];
                const auto& [o1, i1] = cuts[k][c + 1];
                const bool open =
                    k == 1 && gate < 1 &&
                    c == static_cast<std::size_t>(gate * static_cast<double>(cuts[k].size() - 1));
                if (!open && (i1 - i0).norm() > 1) emit({o0, o1, i1, i0});
            }
            const std::size_t n = (k + 1) % 4;
            const auto& [o0, i0] = cuts[k].back();
            const auto& [o1, i1] = cuts[n].front();
            emit({o0, blk[n], o1, i1, in[n], i0});
        }
        if (r.chance(0.35)) {  // a workshop in the court
            const Vec2d d = (in[1] - in[0]).normalized();
            const double across = std::min((in[3] - in[0]).norm(), (in[2] - in[1]).norm());
            if (across > 36) box(inside(in, 0.5, 0.5), d, {r.range(8, 12), r.range(5, 8)});
        }
    }

    void courtyard(const Quad& outer, const Quad& in) {
        if (wet({outer.begin(), outer.end()})) return;
        const RingMm a = to_mm(std::vector<Vec2d>(outer.begin(), outer.end()));
        const RingMm hole = to_mm(std::vector<Vec2d>{in[0], in[3], in[2], in[1]});
        json_.polygon("building", {}, a, hole);
        note(a, area_m2(a) + area_m2(hole));
        ++courtyards_;
    }

    // Two rows of gardens, back to back, a house in each.
    void detached(Random& r, const Quad& blk) {
        for (int side = 0; side < 2; ++side) {
            const Quad half = half_of(blk, side);
            const double length = (half[1] - half[0]).norm();
            const double height = std::min((half[3] - half[0]).norm(), (half[2] - half[1]).norm());
            const Vec2d d = (half[1] - half[0]) / length;
            const int lots = std::max(1, static_cast<int>(length / r.range(18, 24)));
            const double wide = length / lots;
            for (int i = 0; i < lots; ++i) {
                const double a = std::min(r.range(4, 6.4), wide / 2 - 1.6);
                const double b = std::min(r.range(4, 6), height / 2 - 3);
                const double garden = r.range(1.5, 4);
                const bool corner = r.chance(0.3);
                const double x = corner ? a * r.range(-0.1, 0.3) : a;
                const double y = corner ? b * r.range(-0.1, 0.3) : b;
                if (a < 2.5 || b < 2.5 || r.chance(0.04)) continue;
                const Vec2d n = left_of(d);
                const Vec2d c = half[0] + (i + 0.5) * wide * d + (b + garden) * n;
                std::vector<Vec2d> ring{c - a * d - b * n, c + a * d - b * n, c + a * d + y * n};
                if (corner) ring.insert(ring.end(), {c + x * d + y * n, c + x * d + b * n});
                ring.emplace_back(c - a * d + b * n);
                if (within(half, ring, 1)) emit(ring);
            }
        }
    }

    // Terraces along both long sides, five to nine houses each.
    void rows(Random& r, const Quad& blk) {
        for (int side = 0; side < 2; ++side) {
            const Quad half = half_of(blk, side);
            const double length = (half[1] - half[0]).norm();
            const double height = std::min((half[3] - half[0]).norm(), (half[2] - half[1]).norm());
            const double deep = std::min(10.0, height - 6);
            if (deep < 5) continue;
            const Vec2d d = (half[1] - half[0]) / length;
            const Vec2d n = left_of(d);
            double s = 9;
            while (s < length - 14) {
                const double w = r.range(6.4, 8.4);
                const int houses =
                    std::min(r.between(5, 9), static_cast<int>((length - 9 - s) / w));
                const double front = r.range(2.5, 4.5);
                const auto at = [&](int k, double t) {
                    return Vec2d(half[0] + (s + k * w) * d + t * n);
                };
                for (int k = 0; k < houses; ++k) {
                    const std::vector<Vec2d> ring{at(k, front), at(k + 1, front),
                                                  at(k + 1, front + deep), at(k, front + deep)};
                    if (within(half, ring, 1)) emit(ring);
                }
                s += std::max(houses, 1) * w + r.range(6, 12);
            }
        }
    }

    // Slabs or towers on open ground, with low buildings between them.
    void estate(Random& r, const Quad& blk, bool towers) {
        const double length = std::min((blk[1] - blk[0]).norm(), (blk[2] - blk[3]).norm());
        const double height = std::min((blk[3] - blk[0]).norm(), (blk[2] - blk[1]).norm());
        const Vec2d d = (0.5 * (blk[1] + blk[2]) - 0.5 * (blk[0] + blk[3])).normalized();
        const double cell_w = towers ? 42 : 74;
        const double cell_h = towers ? 42 : 34;
        const int nu = std::max(1, static_cast<int>(length / cell_w));
        const int nv = std::max(1, static_cast<int>(height / cell_h));
        for (int v = 0; v < nv; ++v) {
            for (int u = 0; u < nu; ++u) {
                const Vec2d c = inside(blk, (u + 0.5) / nu, (v + 0.5) / nv);
                const bool low = r.chance(towers ? 0.4 : 0.25);
                if (low) {
                    box(c, d, {r.range(4, 9), r.range(4, 6)});
                } else if (towers) {
                    box(c, d, {r.range(8, 12), r.range(8, 12)});
                } else {
                    box(c, d, {r.range(19, 27), r.range(5.5, 7)});
                }
            }
        }
    }

    void park(Random& r, const Quad& q) {
        for (int i = r.between(1, 4); i > 0; --i) {
            // One pavilion in each quarter of the park, so that they keep apart.
            const Vec2d c =
                inside(q, 0.25 + 0.5 * (i % 2) + r.range(-0.1, 0.1), (i > 2 ? 0.3 : 0.7));
            const Vec2d d = direction(r.below(direction_count));
            box(c, d, {r.range(4, 8), r.range(3, 6)});
        }
    }

    // Braces, because the order in which a call evaluates its arguments is the compiler's choice.
    struct Half {
        double w, d;
    };
    void box(const Vec2d& c, const Vec2d& d, const Half& half) {
        const Vec2d a = half.w * d;
        const Vec2d b = half.d * left_of(d);
        emit({c - a - b, c + a - b, c + a + b, c - a + b});
    }

    bool wet(const std::vector<Vec2d>& ring) const {
        return std::any_of(ring.begin(), ring.end(), [&](const Vec2d& p) {
            const double at = std::clamp(p.y(), 0.0, size_m_) / river_step;
            const auto k = static_cast<std::size_t>(at);
            const double f = at - std::floor(at);
            return std::abs(p.x() - (1 - f) * river_[k] - f * river_[k + 1]) < river_half_ + 15;
        });
    }

    void emit(const std::vector<Vec2d>& ring) {
        if (wet(ring)) return;
        const RingMm mm = to_mm(ring);
        json_.polygon("building", {}, mm);
        note(mm, area_m2(mm));
    }

    void note(const RingMm& ring, double area) {
        const BoxMm box = box_of(ring);
        if (count_ == 0) extent_ = box;
        extent_.min = {std::min(extent_.min.x, box.min.x), std::min(extent_.min.y, box.min.y)};
        extent_.max = {std::max(extent_.max.x, box.max.x), std::max(extent_.max.y, box.max.y)};
        ++count_;
        area_m2_ += area;
    }

    std::uint64_t seed_;
    double size_m_;
    int n_;  // quarters per side
    GeoJson json_;
    std::vector<double> river_;  // x of the river's middle every river_step in y
    double river_half_ = 0;
    double core_m_ = 0;
    std::array<int, 6> quarters_{};
    std::int64_t count_ = 0;
    std::int64_t courtyards_ = 0;
    double area_m2_ = 0;
    BoxMm extent_{};
};

}  // namespace

GenerateReport city(std::uint64_t seed, double size_km) { return City(seed, size_km * 1000).run(); }

}  // namespace vfplan::generate
