#include "kernels/noding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "kernels/error.h"
#include "kernels/index.h"

namespace vfplan {
namespace {

constexpr std::int64_t half = fine_steps / 2;

std::int64_t floor_div(Wide n, Wide d) {  // d > 0
    const Wide q = n / d;
    return static_cast<std::int64_t>(n % d < 0 ? q - 1 : q);
}

std::int64_t pixel_of(std::int64_t fine) { return floor_div(fine + half, fine_steps); }

int sign(Wide v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }

bool cross_properly(const LabelledSegment& s, const LabelledSegment& t) {
    if (std::max(s.a.x, s.b.x) < std::min(t.a.x, t.b.x)) return false;
    if (std::max(t.a.x, t.b.x) < std::min(s.a.x, s.b.x)) return false;
    if (std::max(s.a.y, s.b.y) < std::min(t.a.y, t.b.y)) return false;
    if (std::max(t.a.y, t.b.y) < std::min(s.a.y, s.b.y)) return false;
    return sign(turn(s.a, s.b, t.a)) * sign(turn(s.a, s.b, t.b)) < 0 &&
           sign(turn(t.a, t.b, s.a)) * sign(turn(t.a, t.b, s.b)) < 0;
}

// The pixel in which two segments cross properly.
LatticePoint crossing_pixel(const LabelledSegment& s, const LabelledSegment& t) {
    Wide num = turn(t.a, t.b, s.a);
    Wide den = num - turn(t.a, t.b, s.b);
    if (den < 0) {
        num = -num;
        den = -den;
    }
    // s.a + (s.b - s.a) num / den, counted from the middle of the pixel of s.a.
    const auto along = [&](std::int64_t from, std::int64_t to) {
        const std::int64_t pixel = pixel_of(from);
        const std::int64_t inside = from - pixel * fine_steps;
        return pixel +
               floor_div(Wide(inside + half) * den + Wide(to - from) * num, Wide(fine_steps) * den);
    };
    return {along(s.a.x, s.b.x), along(s.a.y, s.b.y)};
}

// True when a segment has a point in a pixel. Of the pixel's corners only the lower left one is its
// own.
bool passes(const LabelledSegment& s, const LatticePoint& pixel) {
    const LatticePoint c{pixel.x * fine_steps, pixel.y * fine_steps};
    const LatticePoint a{s.a.x - c.x, s.a.y - c.y};
    const LatticePoint b{s.b.x - c.x, s.b.y - c.y};
    if (std::max(a.x, b.x) < -half || std::min(a.x, b.x) >= half) return false;
    if (std::max(a.y, b.y) < -half || std::min(a.y, b.y) >= half) return false;
    const int own = sign(turn(a, b, {-half, -half}));
    if (own == 0) return true;
    return sign(turn(a, b, {half, -half})) == -own || sign(turn(a, b, {half, half})) == -own ||
           sign(turn(a, b, {-half, half})) == -own;
}

// Squares over the plane, by which segments and pixels that may meet are found. Numbered by x and y
// in one key.
class Squares {
public:
    explicit Squares(std::span<const LabelledSegment> segments) {
        std::vector<double> lengths;
        lengths.reserve(segments.size());
        double sum = 0;
        for (const LabelledSegment& s : segments) {
            if (s.a == s.b) continue;
            lengths.push_back(
                std::hypot(static_cast<double>(s.b.x - s.a.x), static_cast<double>(s.b.y - s.a.y)));
            sum += lengths.back();
        }
        if (lengths.empty()) lengths.push_back(0);
        // A quarter of the mean bounds how many squares all segments pass together, whatever their
        // lengths; the median keeps a few long ones from making squares coarse.
        const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
        std::nth_element(lengths.begin(), middle, lengths.end());
        const double side = std::max(*middle, sum / (4 * static_cast<double>(lengths.size())));
        side_ =
            std::max<std::int64_t>(64, static_cast<std::int64_t>(side / fine_steps)) * fine_steps;
    }

    std::uint64_t key_of(const LatticePoint& fine) const {
        return key(floor_div(fine.x, side_), floor_div(fine.y, side_));
    }

    // Calls f for every square that a segment comes within a pixel of, and perhaps a few more.
    template <class F>
    void each_near(const LabelledSegment& s, F&& f) const {
        constexpr std::int64_t pad = 2 * fine_steps;
        const auto [left, right] = std::minmax(s.a, s.b);  // by x first
        const std::int64_t from = floor_div(left.x - pad, side_);
        const std::int64_t to = floor_div(right.x + pad, side_);
        const double slope = right.x > left.x ? static_cast<double>(right.y - left.y) /
                                                    static_cast<double>(right.x - left.x)
                                              : 0;
        const std::int64_t y_min = std::min(left.y, right.y);
        const std::int64_t y_max = std::max(left.y, right.y);
        for (std::int64_t column = from; column <= to; ++column) {
            std::int64_t low = y_min;
            std::int64_t high = y_max;
            if (right.x > left.x && from < to) {
                const std::int64_t x0 = std::max(left.x, column * side_ - pad);
                const std::int64_t x1 = std::min(right.x, (column + 1) * side_ + pad);
                const auto y_at = [&, left = left](std::int64_t x) {
                    const double y = slope * static_cast<double>(x - left.x);
                    return std::clamp<std::int64_t>(left.y + std::llround(y), y_min, y_max);
                };
                low = std::min(y_at(x0), y_at(x1));
                high = std::max(y_at(x0), y_at(x1));
            }
            const std::int64_t row_to = floor_div(high + pad, side_);
            for (std::int64_t row = floor_div(low - pad, side_); row <= row_to; ++row) {
                f(key(column, row));
            }
        }
    }

private:
    static std::uint64_t key(std::int64_t column, std::int64_t row) {
        return static_cast<std::uint64_t>(column) << 32 ^
               (static_cast<std::uint64_t>(row) & 0xffffffffU);
    }
    std::int64_t side_ = 0;
};

template <class T>
struct InSquare {
    std::uint64_t square;
    T what;
    friend auto operator<=>(const InSquare&, const InSquare&) = default;
};

template <class T>
void sort_unique(std::vector<T>& v) {
    std::sort(v.begin(), v.end());
    v.erase(std::unique(v.begin(), v.end()), v.end());
}

// The end of the run of equal squares that starts at `from`.
template <class T>
std::size_t run_end(const std::vector<InSquare<T>>& v, std::size_t from) {
    std::size_t to = from;
    while (to < v.size() && v[to].square == v[from].square) ++to;
    return to;
}

using SegmentsInSquares = std::vector<InSquare<std::int32_t>>;

std::vector<LatticePoint> hot_pixels(std::span<const LabelledSegment> segments,
                                     const SegmentsInSquares& in_squares,
                                     std::vector<Noded::SelfCrossing>& self_crossings) {
    std::vector<LatticePoint> hot;
    hot.reserve(2 * segments.size());
    for (const LabelledSegment& s : segments) {
        hot.push_back(vfplan::pixel_of(s.a));
        hot.push_back(vfplan::pixel_of(s.b));
    }
    for (std::size_t i = 0; i < in_squares.size();) {
        const std::size_t end = run_end(in_squares, i);
        for (; i < end; ++i) {
            const LabelledSegment& s = segments[idx(in_squares[i].what)];
            for (std::size_t k = i + 1; k < end; ++k) {
                const LabelledSegment& t = segments[idx(in_squares[k].what)];
                if (!cross_properly(s, t)) continue;
                hot.push_back(crossing_pixel(s, t));
                if (s.label == t.label) self_crossings.push_back({s.label, hot.back()});
            }
        }
    }
    sort_unique(hot);
    return hot;
}

// A stretch between two hot pixels, one label of it.
struct Stretch {
    LatticePoint a;
    LatticePoint b;
    std::int32_t label;
    friend auto operator<=>(const Stretch&, const Stretch&) = default;
};

// Leads a segment through the hot pixels that it passes.
void lead(const LabelledSegment& s, std::vector<LatticePoint>& passed, std::vector<Stretch>& out) {
    // Along a segment x and y of the pixels never turn back, so their sum in its direction orders
    // them.
    const std::int64_t sx = s.b.x >= s.a.x ? 1 : -1;
    const std::int64_t sy = s.b.y >= s.a.y ? 1 : -1;
    std::sort(passed.begin(), passed.end(), [&](const LatticePoint& p, const LatticePoint& q) {
        return sx * p.x + sy * p.y < sx * q.x + sy * q.y;
    });
    for (std::size_t i = 1; i < passed.size(); ++i) {
        const auto [a, b] = std::minmax(passed[i - 1], passed[i]);
        out.push_back({a, b, s.label});
    }
}

std::vector<Stretch> stretches(std::span<const LabelledSegment> segments, const Squares& squares,
                               const SegmentsInSquares& in_squares,
                               const std::vector<LatticePoint>& hot) {
    std::vector<InSquare<LatticePoint>> pixels;
    pixels.reserve(hot.size());
    for (const LatticePoint& p : hot) {
        pixels.push_back({squares.key_of({p.x * fine_steps, p.y * fine_steps}), p});
    }
    std::sort(pixels.begin(), pixels.end());
    struct Hit {
        std::int32_t segment;
        LatticePoint pixel;
        auto operator<=>(const Hit&) const = default;
    };
    std::vector<Hit> hits;
    hits.reserve(3 * segments.size());
    for (std::size_t i = 0, p = 0; i < in_squares.size();) {
        const std::size_t end = run_end(in_squares, i);
        while (p < pixels.size() && pixels[p].square < in_squares[i].square) ++p;
        const std::size_t p_end =
            p < pixels.size() && pixels[p].square == in_squares[i].square ? run_end(pixels, p) : p;
        for (; i < end; ++i) {
            for (std::size_t k = p; k < p_end; ++k) {
                if (passes(segments[idx(in_squares[i].what)], pixels[k].what)) {
                    hits.push_back({in_squares[i].what, pixels[k].what});
                }
            }
        }
    }
    std::sort(hits.begin(), hits.end());
    std::vector<Stretch> out;
    out.reserve(hits.size());
    std::vector<LatticePoint> passed;
    for (std::size_t i = 0; i < hits.size();) {
        const std::int32_t segment = hits[i].segment;
        passed.clear();
        for (; i < hits.size() && hits[i].segment == segment; ++i) passed.push_back(hits[i].pixel);
        lead(segments[idx(segment)], passed, out);
    }
    std::sort(out.begin(), out.end());
    return out;
}

void check_spread(std::span<const LabelledSegment> segments) {
    LatticePoint lo = segments.front().a;
    LatticePoint hi = lo;
    for (const LabelledSegment& s : segments) {
        for (const LatticePoint& p : {s.a, s.b}) {
            lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
            hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
        }
    }
    if (hi.x - lo.x <= farthest_fine && hi.y - lo.y <= farthest_fine) return;
    throw InputError(
        "walls that touch each other spread over more than a thousand million site.snap_m; set "
        "site.crop_m, or a larger site.snap_m");
}

}  // namespace

LatticePoint pixel_of(const LatticePoint& fine) { return {pixel_of(fine.x), pixel_of(fine.y)}; }

std::span<const std::int32_t> Noded::labels_of(std::size_t edge) const {
    const std::size_t from = edges[edge].first_label;
    const std::size_t to = edge + 1 < edges.size() ? edges[edge + 1].first_label : labels.size();
    return std::span(labels).subspan(from, to - from);
}

Noded node(std::span<const LabelledSegment> segments) {
    Noded out;
    if (segments.empty()) return out;
    check_spread(segments);
    const Squares squares(segments);
    SegmentsInSquares in_squares;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        squares.each_near(segments[i], [&](std::uint64_t square) {
            in_squares.push_back({square, static_cast<std::int32_t>(i)});
        });
    }
    std::sort(in_squares.begin(), in_squares.end());
    const std::vector<LatticePoint> hot = hot_pixels(segments, in_squares, out.self_crossings);
    std::sort(out.self_crossings.begin(), out.self_crossings.end(),
              [](const auto& p, const auto& q) {
                  return std::tie(p.label, p.at) < std::tie(q.label, q.at);
              });
    out.self_crossings.erase(std::unique(out.self_crossings.begin(), out.self_crossings.end(),
                                         [](const auto& p, const auto& q) {
                                             return p.label == q.label && p.at == q.at;
                                         }),
                             out.self_crossings.end());
    for (const Stretch& s : stretches(segments, squares, in_squares, hot)) {
        if (out.edges.empty() || out.edges.back().a != s.a || out.edges.back().b != s.b) {
            out.edges.push_back({s.a, s.b, out.labels.size()});
        }
        out.labels.push_back(s.label);
    }
    return out;
}

}  // namespace vfplan
