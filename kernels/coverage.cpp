#include "kernels/coverage.h"

#include <algorithm>
#include <cmath>

#include "kernels/angle.h"

namespace vfplan {
namespace {

struct Part {
    std::int32_t piece;
    double length_m;
    double of_m;  // the whole piece
    double angle_rad;
};

}  // namespace

void Pieces::add_wall(double length_m, std::int32_t on_left, std::int32_t on_right) {
    length_m_.push_back(length_m);
    first_.push_back(first_.back() + on_left);
    first_.push_back(first_.back() + on_right);
}

Pieces::Place Pieces::place(std::int64_t piece) const {
    const auto next =
        std::upper_bound(first_.begin(), first_.end(), static_cast<std::int32_t>(piece));
    const auto face = static_cast<std::int32_t>(next - first_.begin()) - 1;
    const auto f = static_cast<std::size_t>(face);
    const auto k = static_cast<std::int32_t>(piece) - first_[f];
    const std::int32_t n = first_[f + 1] - first_[f];
    const double length = length_m_[f / 2];
    return {face / 2, static_cast<Side>(face % 2), piece_begin_m(length, k, n),
            piece_begin_m(length, k + 1, n)};
}

double Pieces::length_m(std::int64_t piece) const {
    const Place p = place(piece);
    return p.s1_m - p.s0_m;
}

std::int32_t pieces_along(double length_m, double partition_m) {
    return static_cast<std::int32_t>(std::max(1.0, std::ceil(length_m / partition_m - 1e-9)));
}

Pieces cut_into_pieces(const std::vector<Wall>& walls, double partition_m) {
    Pieces out;
    for (const Wall& wall : walls) {
        const double length = wall.length_m();
        const std::int32_t n = wall.scanned ? pieces_along(length, partition_m) : 0;
        out.add_wall(length, wall.free_side[left] ? n : 0, wall.free_side[right] ? n : 0);
    }
    return out;
}

std::vector<double> piece_lengths_m(const Pieces& pieces) {
    std::vector<double> out;
    out.reserve(static_cast<std::size_t>(pieces.size()));
    for (std::int32_t wall = 0; wall < pieces.walls(); ++wall) {
        const double length = pieces.wall_length_m(wall);
        for (const Side side : {left, right}) {
            const std::int32_t n = pieces.count(wall, side);
            for (std::int32_t k = 0; k < n; ++k) {
                out.push_back(piece_begin_m(length, k + 1, n) - piece_begin_m(length, k, n));
            }
        }
    }
    return out;
}

CoverageRow coverage_row(const std::vector<Wall>& walls, const Pieces& pieces, const Vec2d& eye,
                         const View& observed, double visible_fraction, bool angles) {
    std::vector<Part> parts;
    for (const Span& span : observed) {
        const auto w = static_cast<std::size_t>(span.wall);
        const std::int32_t n = pieces.count(span.wall, span.side);
        if (n == 0) continue;
        const std::int32_t first = pieces.first(span.wall, span.side);
        const Wall& wall = walls[w];
        const double length = wall.length_m();
        const Vec2d e = (wall.b - wall.a) / length;
        const double foot = (eye - wall.a).dot(e);
        const double height = std::abs(cross(e, eye - wall.a));
        const double from = std::min(span.s_begin_m, span.s_end_m);
        const double to = std::max(span.s_begin_m, span.s_end_m);
        const auto clamp = [&](double v) {
            return static_cast<std::int32_t>(std::clamp(std::floor(v), 0.0, n - 1.0));
        };
        for (std::int32_t k = clamp(from / length * n); k <= clamp(to / length * n); ++k) {
            const double begin = piece_begin_m(length, k, n);
            const double end = piece_begin_m(length, k + 1, n);
            const double lo = std::max(from, begin);
            const double hi = std::min(to, end);
            if (!(hi > lo)) continue;
            const double angle_rad =
                angles ? angle_upper_rad(height * (hi - lo),
                                         height * height + (lo - foot) * (hi - foot))
                       : 0;
            parts.push_back({first + k, hi - lo, end - begin, angle_rad});
        }
    }
    std::stable_sort(parts.begin(), parts.end(),
                     [](const Part& p, const Part& q) { return p.piece < q.piece; });
    CoverageRow row;
    for (std::size_t i = 0; i < parts.size();) {
        Part sum = parts[i];
        for (++i; i < parts.size() && parts[i].piece == sum.piece; ++i) {
            sum.length_m += parts[i].length_m;
            sum.angle_rad += parts[i].angle_rad;
        }
        const double fraction = std::min(1.0, sum.length_m / sum.of_m);
        if (fraction + 1e-9 < visible_fraction) continue;
        row.push_back({sum.piece, static_cast<float>(fraction), static_cast<float>(sum.angle_rad)});
    }
    return row;
}

void CoverageTable::add(const CoverageRow& row) {
    seen.insert(seen.end(), row.begin(), row.end());
    begin.push_back(static_cast<std::int64_t>(seen.size()));
}

}  // namespace vfplan
