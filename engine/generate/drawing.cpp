#include "engine/generate/drawing.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace vfplan::generate {

double area_m2(const RingMm& ring) {
    // Relative to the first point, so that the products of a 60 km city stay small.
    std::int64_t twice = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        twice += (ring[i].x - ring[0].x) * (ring[i + 1].y - ring[0].y) -
                 (ring[i].y - ring[0].y) * (ring[i + 1].x - ring[0].x);
    }
    return static_cast<double>(twice) / 2e6;
}

BoxMm box_of(const RingMm& ring) {
    BoxMm box{ring.at(0), ring.at(0)};
    for (const PointMm& p : ring) {
        box.min = {std::min(box.min.x, p.x), std::min(box.min.y, p.y)};
        box.max = {std::max(box.max.x, p.x), std::max(box.max.y, p.y)};
    }
    return box;
}

void append_metres(std::string& out, std::int64_t mm) {
    if (mm < 0) {
        out += '-';
        mm = -mm;
    }
    std::array<char, 24> digits{};
    char* at = digits.data() + digits.size();
    int written = 0;
    while (written < 4 || mm > 0) {
        if (written == 3) *--at = '.';
        *--at = static_cast<char>('0' + mm % 10);
        mm /= 10;
        ++written;
    }
    out.append(at, static_cast<std::size_t>(digits.data() + digits.size() - at));
}

GeoJson::GeoJson(const std::string& name)
    : out_(R"({"type":"FeatureCollection","name":")" + name +
           R"(","units":"m","origin":[0,0],"crs_note":"synthetic, plane metres","features":[)"
           "\n") {}

void GeoJson::begin(std::string_view cls, std::string_view extra, const char* type) {
    if (!first_) out_ += ",\n";
    first_ = false;
    out_ += R"({"type":"Feature","properties":{"class":")";
    out_ += cls;
    out_ += '"';
    if (!extra.empty()) out_ += ',';
    out_ += extra;
    out_ += R"(},"geometry":{"type":")";
    out_ += type;
    out_ += R"(","coordinates":)";
}

void GeoJson::ring(const RingMm& points, bool closed) {
    out_ += '[';
    for (std::size_t i = 0; i < points.size() + (closed ? 1 : 0); ++i) {
        const PointMm& p = points[i % points.size()];
        out_ += i == 0 ? "[" : ",[";
        append_metres(out_, p.x);
        out_ += ',';
        append_metres(out_, p.y);
        out_ += ']';
    }
    out_ += ']';
}

void GeoJson::polygon(std::string_view cls, std::string_view extra, const RingMm& outer,
                      const RingMm& hole) {
    begin(cls, extra, "Polygon");
    out_ += '[';
    ring(outer, true);
    if (!hole.empty()) {
        out_ += ',';
        ring(hole, true);
    }
    out_ += "]}}";
}

void GeoJson::line(std::string_view cls, const RingMm& points) {
    begin(cls, {}, "LineString");
    ring(points, false);
    out_ += "}}";
}

std::string GeoJson::finish() {
    out_ += "\n]}\n";
    return std::move(out_);
}

Vec2d direction(int i) {
    constexpr std::array<std::array<double, 3>, direction_count> triples{{{21, -20, 29},
                                                                          {4, -3, 5},
                                                                          {15, -8, 17},
                                                                          {12, -5, 13},
                                                                          {24, -7, 25},
                                                                          {60, -11, 61},
                                                                          {1, 0, 1},
                                                                          {60, 11, 61},
                                                                          {24, 7, 25},
                                                                          {12, 5, 13},
                                                                          {15, 8, 17},
                                                                          {4, 3, 5},
                                                                          {21, 20, 29}}};
    const auto& t = triples[static_cast<std::size_t>(i % direction_count)];
    return {t[0] / t[2], t[1] / t[2]};
}

std::string fixed(double value, int decimals) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
    return text.data();
}

std::string grouped(std::int64_t value) {
    std::string text = std::to_string(value);
    for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, 1, ',');
    return text;
}

}  // namespace vfplan::generate
