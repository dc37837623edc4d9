#include "io/site/linework.h"

#include <cmath>

namespace vfplan {

void Linework::add_points(const std::vector<Vec2d>& points, bool closed) {
    const double scale = static_cast<double>(fine_steps) / snap_m_;
    const auto fine = [&](const Vec2d& p) {
        return LatticePoint{std::llround(p.x() * scale), std::llround(p.y() * scale)};
    };
    const auto label = static_cast<std::int32_t>(sources_.size() - 1);
    for (std::size_t i = closed ? 0 : 1; i < points.size(); ++i) {
        const Vec2d& before = i == 0 ? points.back() : points[i - 1];
        segments_.push_back({fine(before), fine(points[i]), label});
    }
}

void Linework::add(const Polygon& polygon, const Source& source) {
    sources_.push_back(source);
    add_points(polygon.outer, true);
    for (const Ring& hole : polygon.holes) add_points(hole, true);
}

void Linework::add(const Line& line, const Source& source) {
    sources_.push_back(source);
    sources_.back().kind = line_kind;
    add_points(line, false);
}

std::int32_t Linework::add(const LatticePoint& a, const LatticePoint& b, const Source& source) {
    sources_.push_back(source);
    const auto label = static_cast<std::int32_t>(sources_.size() - 1);
    add(a, b, label);
    return label;
}

void Linework::add(const LatticePoint& a, const LatticePoint& b, std::int32_t label) {
    segments_.push_back(
        {{a.x * fine_steps, a.y * fine_steps}, {b.x * fine_steps, b.y * fine_steps}, label});
}

}  // namespace vfplan
